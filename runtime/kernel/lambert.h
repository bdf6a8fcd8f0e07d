/* lambert.h - Lambert's kernel: what two pieces of surface exchange.
 *
 * Of points x, y with unit normals n, m, r = y - x, s = r.r, the kernel is (n.r)(-m.r) / (pi s^2),
 * in 1/m2. Of faces, to second order in their size over their distance, it is taken at the
 * centroids and weighted with both faces' second moments M (m2):
 *     pi k = a b / s^2 + a b (12 r.Qr / s^4 - 2 tr Q / s^3) - 4 (a m.M_i r + b n.M_j r) / s^3,   Q
 *     = M_i + M_j,
 * a = n.r, b = m.r, m here the normal of j turned round; n M_i = 0 and m M_j = 0 because faces are
 * flat. What that leaves out is of fourth order.
 * [Taylor's formula for Lambert's kernel, derived here]
 * SPDX-License-Identifier: MIT */
#ifndef KERNEL_LAMBERT_H
#define KERNEL_LAMBERT_H

#include "discussion.h"
#include "kernel/lanes.h"
#include "kernel/plain_math.h"

#define LAMBERT_PI 3.14159265358979323846

/* The kernel of points on front sides, else 0 (1/m2), by their cosines times their distance and its
 * square. `spread` (m2), a piece's area, bounds it where pieces touch: no more than about 1 /
 * spread is exchanged. Has no branch, for loops that run several at a time. */
TOOL double lambert_kernel(double cos_x, double cos_y, double square, double spread)
{
    double k = cos_x * cos_y / (square * (LAMBERT_PI * square + spread));
    k = cos_x > 0 ? k : 0;
    return cos_y > 0 ? k : 0;
}

static inline double lambert_points(const double x[3], const double n[3], const double y[3],
                                    const double m[3], double spread)
{
    double w[3];
    sub3(w, y, x);
    return lambert_kernel(dot3(n, w), -dot3(m, w), dot3(w, w), spread);
}

/* theta Gamma.n of an edge from a to b, both as seen from the point. */
TOOL double lambert_edge(double a0, double a1, double a2, double b0, double b1, double b2,
                         double n0, double n1, double n2)
{
    double c0 = a1 * b2 - a2 * b1, c1 = a2 * b0 - a0 * b2, c2 = a0 * b1 - a1 * b0;
    double size = sqrt(c0 * c0 + c1 * c1 + c2 * c2), some = size > 0 ? size : 1;
    double part =
        plain_angle(size, a0 * b0 + a1 * b1 + a2 * b2) / some * (c0 * n0 + c1 * n1 + c2 * n2);
    return size > 0 ? part : 0;
}

/* Corners less points, the points of a corner one after the other: the last corner, then all. So an
 * edge ends as many places after its beginning as there are points. */
enum { LAMBERT_POINTS = 9, LAMBERT_CORNERS = (POLYGON_MAX + 1) * LAMBERT_POINTS + LANES_MOST };
struct lambert_edges {
    int points, count; /* edges in all */
    double n[3], x[LAMBERT_CORNERS], y[LAMBERT_CORNERS], z[LAMBERT_CORNERS], value[LAMBERT_CORNERS];
};

TOOL void lambert_edges_body(struct lambert_edges *g)
{
    const double n0 = g->n[0], n1 = g->n[1], n2 = g->n[2];
    const int on = g->points, count = g->count;
    for (int i = 0; i < count; i += LANES) {
        const double *x = g->x + i, *y = g->y + i, *z = g->z + i;
        double value[LANES]; /* its own, for what ends an edge might stand where values do */
        for (int k = 0; k < LANES; k++)
            value[k] = lambert_edge(x[k], y[k], z[k], x[k + on], y[k + on], z[k + on], n0, n1, n2);
        for (int k = 0; k < LANES; k++)
            g->value[i + k] = value[k];
    }
}

#if LANES_CHOSEN
LANES_AVX512 void lambert_edges_8(struct lambert_edges *g)
{
    lambert_edges_body(g);
}
LANES_AVX2 void lambert_edges_4(struct lambert_edges *g)
{
    lambert_edges_body(g);
}
#endif

OUTLINE void lambert_edges_at(int width, struct lambert_edges *g)
{
    LANES_RUN(width, lambert_edges_8, lambert_edges_4, lambert_edges_body, (g));
}

/* The form factors from `points` points, normal n, to a flat convex polygon v[count] in front of
 * them, each in (0, 1]; negative seen from its back: -(1/2pi) sum theta_i Gamma_i.n over its edges,
 * theta_i the angle that edge i subtends at the point, Gamma_i the unit normal of the plane through
 * both. [Lambert 1760] */
static inline void lambert_sums(int points, const double (*at)[3], const double n[3],
                                const double (*v)[3], int count, double *out)
{
    struct lambert_edges g;
    g.points = points;
    g.count = count < 3 ? 0 : points * count;
    for (int k = 0; k < 3; k++)
        g.n[k] = n[k];
    for (int j = 0; j <= count && g.count; j++) {
        const double *corner = v[j > 0 ? j - 1 : count - 1];
        for (int i = 0; i < points; i++) {
            g.x[j * points + i] = corner[0] - at[i][0];
            g.y[j * points + i] = corner[1] - at[i][1];
            g.z[j * points + i] = corner[2] - at[i][2];
        }
    }
    for (int k = g.count; k % LANES; k++)
        g.x[k + points] = g.y[k + points] = g.z[k + points] = 0;
    lambert_edges_at(lanes_width(), &g);
    for (int i = 0; i < points; i++) {
        double sum = 0;
        for (int k = i; k < g.count; k += points)
            sum += g.value[k];
        out[i] = sum * (-0.5 / LAMBERT_PI);
    }
}

/* The same of one point. */
static inline double lambert_sum(const double x[3], const double n[3], const double (*v)[3],
                                 int count)
{
    double sum = 0, a[3], b[3];
    if (count < 3)
        return 0;
    sub3(a, v[count - 1], x);
    for (int i = 0; i < count; i++) {
        sub3(b, v[i], x);
        sum += lambert_edge(a[0], a[1], a[2], b[0], b[1], b[2], n[0], n[1], n[2]);
        for (int k = 0; k < 3; k++)
            a[k] = b[k];
    }
    return sum * (-0.5 / LAMBERT_PI);
}

/* pi k of two faces: a = n.r, b = m.r, t = 1 / s, quad = r.Qr, trace = tr Q, skew = a m.M_i r + b
 * n.M_j r. Inlined always, so that loops over faces run several at a time. */
TOOL double lambert_second_order(double a, double b, double t, double quad, double trace,
                                 double skew)
{
    return t * t * (a * b * (1 + t * (12 * t * quad - 2 * trace)) - 4 * t * skew);
}

#endif
