/* sight_shadows.h - shadows of edges on a plane, as seen from a point: eight at a time
 * (kernel/lanes.h), each as it would be alone.
 * Invariant: an edge that is no outline from the point, or no part of which is between the plane
 * and the point, crosses nothing.
 * SPDX-License-Identifier: MIT */
#ifndef SIGHT_SHADOWS_H
#define SIGHT_SHADOWS_H

#include <string.h>
#include "kernel/lanes.h"
#include "kernel/outline.h"

enum { SIGHT_LINES = 8 };

/* Edges across which the number of faces that a ray meets may change, in the coordinates of the
 * plane that shadows are cast on. plane: of the two faces at it, n . p - c; seen from where both
 * turn the same side, it does not. Where there is no edge all is 0. */
struct sight_edge_block {
    double end[2][3][SIGHT_LINES], plane[2][4][SIGHT_LINES];
};

/* Put an edge from p to q, between two planes, in a place: the first of each block before its
 * others.
 */
static inline void sight_edge_put(struct sight_edge_block *edges, int at, const double p[3],
                                  const double q[3], const double left[4], const double right[4])
{
    struct sight_edge_block *block = &edges[at / SIGHT_LINES];
    const int lane = at % SIGHT_LINES;
    if (lane == 0)
        memset(block, 0, sizeof *block);
    for (int k = 0; k < 3; k++) {
        block->end[0][k][lane] = p[k];
        block->end[1][k][lane] = q[k];
    }
    for (int k = 0; k < 4; k++) {
        block->plane[0][k][lane] = left[k];
        block->plane[1][k][lane] = right[k];
    }
}

/* Their shadows in the plane, and the lines these are part of: on them a u + b v = c. */
struct sight_shadows {
    double end[2][2][SIGHT_LINES], a[SIGHT_LINES], b[SIGHT_LINES], c[SIGHT_LINES];
    int64_t crosses[SIGHT_LINES]; /* 1: the cell has corners on both sides of the line */
};

static inline double sight_over(const double (*plane)[SIGHT_LINES], int k, double x, double y,
                                double z)
{
    return plane[0][k] * x + plane[1][k] * y + plane[2][k] * z - plane[3][k];
}

/* Where on the edge, from height p to q, is the end of height h, or what of it is between the plane
 * and `most`? */
static inline double sight_end(double p, double q, double h, double most, double whole)
{
    const double limit = h < 0 ? 0 : most;
    return ((h < 0) | (h > most)) ? (limit - p) / (q - p) : whole;
}

TOOL void sight_shadows_body(const struct sight_edge_block *e, const double from[3],
                             const struct outline_cell *cell, struct sight_shadows *out)
{
    const double x = from[0], y = from[1], height = from[2],
                 most = height * (1 - OUTLINE_BELOW_EYE);
    int64_t outline[SIGHT_LINES], below[SIGHT_LINES] = {0}, above[SIGHT_LINES] = {0};
    for (int k = 0; k < SIGHT_LINES; k++) {
        const double p = e->end[0][2][k], q = e->end[1][2][k], at0 = sight_end(p, q, p, most, 0),
                     at1 = sight_end(p, q, q, most, 1),
                     t0 = height / (height - (p + at0 * (q - p))),
                     t1 = height / (height - (p + at1 * (q - p))), p0 = e->end[0][0][k],
                     p1 = e->end[0][1][k], q0 = e->end[1][0][k], q1 = e->end[1][1][k],
                     x0 = x + t0 * (p0 + at0 * (q0 - p0) - x),
                     y0 = y + t0 * (p1 + at0 * (q1 - p1) - y),
                     x1 = x + t1 * (p0 + at1 * (q0 - p0) - x),
                     y1 = y + t1 * (p1 + at1 * (q1 - p1) - y), a = y1 - y0, b = x0 - x1;
        outline[k] = ((sight_over(e->plane[0], k, x, y, height) > 0)
                      != (sight_over(e->plane[1], k, x, y, height) > 0))
                     & !((p < 0) & (q < 0)) & !((p > most) & (q > most));
        out->end[0][0][k] = x0;
        out->end[0][1][k] = y0;
        out->end[1][0][k] = x1;
        out->end[1][1][k] = y1;
        out->a[k] = a;
        out->b[k] = b;
        out->c[k] = a * x0 + b * y0;
    }
    for (int i = 0; i < cell->n; i++) {
        const double u = cell->p[i][0], v = cell->p[i][1];
        for (int k = 0; k < SIGHT_LINES; k++) {
            const double h = out->a[k] * u + out->b[k] * v - out->c[k];
            above[k] |= h > 0;
            below[k] |= h < 0;
        }
    }
    for (int k = 0; k < SIGHT_LINES; k++)
        out->crosses[k] = outline[k] & above[k] & below[k];
}

/* May an edge be an outline from within the hull of some points? Not where all of these are over
 * both planes, or under both. */
TOOL void sight_turn_body(const struct sight_edge_block *e, const double (*from)[3], int n,
                          int64_t turns[SIGHT_LINES])
{
    int64_t over[SIGHT_LINES] = {0}, under[SIGHT_LINES] = {0};
    for (int i = 0; i < n; i++) {
        const double x = from[i][0], y = from[i][1], z = from[i][2];
        for (int k = 0; k < SIGHT_LINES; k++) {
            const double g = sight_over(e->plane[0], k, x, y, z),
                         h = sight_over(e->plane[1], k, x, y, z);
            over[k] |= (g > 0) | (h > 0);
            under[k] |= !(g > 0) | !(h > 0);
        }
    }
    for (int k = 0; k < SIGHT_LINES; k++)
        turns[k] = over[k] & under[k];
}

#if LANES_CHOSEN
LANES_AVX512 void sight_turn_8(const struct sight_edge_block *e, const double (*from)[3], int n,
                               int64_t turns[SIGHT_LINES])
{
    sight_turn_body(e, from, n, turns);
}
LANES_AVX2 void sight_turn_4(const struct sight_edge_block *e, const double (*from)[3], int n,
                             int64_t turns[SIGHT_LINES])
{
    sight_turn_body(e, from, n, turns);
}
LANES_AVX512 void sight_shadows_8(const struct sight_edge_block *e, const double from[3],
                                  const struct outline_cell *cell, struct sight_shadows *out)
{
    sight_shadows_body(e, from, cell, out);
}
LANES_AVX2 void sight_shadows_4(const struct sight_edge_block *e, const double from[3],
                                const struct outline_cell *cell, struct sight_shadows *out)
{
    sight_shadows_body(e, from, cell, out);
}
#endif

static inline void sight_edges_turn(const struct sight_edge_block *e, const double (*from)[3],
                                    int n, int64_t turns[SIGHT_LINES])
{
    LANES_RUN(lanes_width(), sight_turn_8, sight_turn_4, sight_turn_body, (e, from, n, turns));
}

static inline void sight_shadows_cast(const struct sight_edge_block *e, const double from[3],
                                      const struct outline_cell *cell, struct sight_shadows *out)
{
    LANES_RUN(lanes_width(), sight_shadows_8, sight_shadows_4, sight_shadows_body,
              (e, from, cell, out));
}

#endif
