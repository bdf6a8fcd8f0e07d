/* shaft_pierced.h - a proof, for little, that a face stands in a shaft: a segment between corners
 * of the shaft's two ends passes through it. Of faces that meet a shaft most are met so, and need
 * not be cut by its planes one after the other.
 *
 * Invariant: what is pierced is also found by cutting (shaft_inside in shaft.h, the face where it
 * is), so which of both says it makes no difference. The point c where the segment passes lies in
 * the hull of the ends, thus below every plane by `slack`, which is 10^5 times as much as rounding
 * moves c; and in the face, thus in the enlarged face by `grow`. Let a loop of corners around c be
 * cut by a plane that has c below its limit by `slack`. Were c outside of what is left, then on a
 * line through c both places where it meets the loop had been cut away; so both were higher than
 * the limit less what corners are off the face's plane, and c between them was, too. A quad bent
 * by more than a quarter of `slack` is therefore not asked. [derived here]
 * Fails (says no, though a face meets): faces that no such segment passes through, as those that
 * reach into the shaft from a side.
 * SPDX-License-Identifier: MIT */
#ifndef KERNEL_SHAFT_PIERCED_H
#define KERNEL_SHAFT_PIERCED_H

#include "discussion.h"
#include "kernel/lanes.h"

/* Corners of one end at a time; and room for all of them. */
enum { SHAFT_FEW = 4, SHAFT_CORNERS = 8 };

/* A face's edges as lines in its plane: what lies within has normal . p > at. */
struct shaft_edges {
    double x[4], y[4], z[4], at[4];
};

TOOL void shaft_edges_of(struct shaft_edges *edges, const double (*v)[3], int n,
                         const double normal[3])
{
    for (int k = 0; k < 4; k++) { /* a triangle's last one twice */
        const double *from = v[k < n ? k : n - 1], *to = v[k + 1 < n ? k + 1 : 0];
        double along[3], inward[3];
        sub3(along, to, from);
        cross3(inward, normal, along);
        edges->x[k] = inward[0];
        edges->y[k] = inward[1];
        edges->z[k] = inward[2];
        edges->at[k] = dot3(inward, from);
    }
}

TOOL int shaft_pierced_body(const struct shaft *shaft, const double (*v)[3], int n,
                            const double normal[3])
{
    struct shaft_edges g;
    double x[SHAFT_CORNERS], y[SHAFT_CORNERS], z[SHAFT_CORNERS], h[SHAFT_CORNERS];
    const int points = shaft->points[0];
    shaft_edges_of(&g, v, n, normal);
    for (int i = 0; i < points || i % SHAFT_FEW; i++) {
        const double *p = shaft->end[0][i < points ? i : 0];
        x[i] = p[0];
        y[i] = p[1];
        z[i] = p[2];
        h[i] = height3(p, v[0], normal);
    }
    for (int j = 0; j < shaft->points[1]; j++) {
        const double *q = shaft->end[1][j], q0 = q[0], q1 = q[1], q2 = q[2],
                     other = height3(q, v[0], normal);
        for (int i = 0; i < points; i += SHAFT_FEW) {
            int64_t any = 0, through[SHAFT_FEW];
            for (int k = 0; k < SHAFT_FEW; k++) {
                const double a0 = x[i + k], a1 = y[i + k], a2 = z[i + k], a = h[i + k],
                             t = a / (a - other), c0 = a0 + t * (q0 - a0), c1 = a1 + t * (q1 - a1),
                             c2 = a2 + t * (q2 - a2);
                through[k] = (a * other < 0) & (g.x[0] * c0 + g.y[0] * c1 + g.z[0] * c2 > g.at[0])
                             & (g.x[1] * c0 + g.y[1] * c1 + g.z[1] * c2 > g.at[1])
                             & (g.x[2] * c0 + g.y[2] * c1 + g.z[2] * c2 > g.at[2])
                             & (g.x[3] * c0 + g.y[3] * c1 + g.z[3] * c2 > g.at[3]);
            }
            for (int k = 0; k < SHAFT_FEW; k++)
                any |= through[k];
            if (any)
                return 1;
        }
    }
    return 0;
}

#if LANES_CHOSEN
LANES_AVX2 int shaft_pierced_4(const struct shaft *shaft, const double (*v)[3], int n,
                               const double normal[3])
{
    return shaft_pierced_body(shaft, v, n, normal);
}
#endif

OUTLINE int shaft_pierced_at(int width, const struct shaft *shaft, const double (*v)[3], int n,
                             const double normal[3])
{
    return LANES_RUN(width, shaft_pierced_4, shaft_pierced_4, shaft_pierced_body,
                     (shaft, v, n, normal));
}

/* Is a face with 3 or 4 corners, whose unit normal is given, pierced for sure? */
static inline int shaft_pierced(const struct shaft *shaft, const double (*v)[3], int n,
                                const double normal[3])
{
    return (n == 3 || fabs(height3(v[1], v[0], normal)) <= 0.25 * shaft->slack)
           && shaft_pierced_at(lanes_width(), shaft, v, n, normal);
}

#endif
