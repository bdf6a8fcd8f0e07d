/* surface_point.h - point (s, t) of the unit square on a surface: evenly spread over a triangle or
 * a parallelogram.
 *
 * A triangle is the square folded at its diagonal, s drawn to its root so that area is kept; a quad
 * is bilinear, exactly even only as a parallelogram. The even point is evenly spread over any
 * quad, for which s chooses among the two triangles beside the diagonal 0-2; it tears nearby (s, t)
 * apart there.
 * SPDX-License-Identifier: MIT */
#ifndef KERNEL_SURFACE_POINT_H
#define KERNEL_SURFACE_POINT_H

#include "discussion.h"
#include "kernel/constants.h"

static inline void surface_point(double p[3], const struct element *e, double s, double t)
{
    if (e->vertices == 3) {
        s = sqrt(s);
        for (int k = 0; k < 3; k++) {
            const double a = e->vertex[0][k], b = e->vertex[1][k], c = e->vertex[2][k];
            p[k] = a + s * (b - a) + s * t * (c - b);
        }
    } else {
        for (int k = 0; k < 3; k++) {
            const double a = e->vertex[0][k], b = e->vertex[1][k], c = e->vertex[2][k],
                         d = e->vertex[3][k];
            p[k] = (1 - t) * (a + s * (b - a)) + t * (d + s * (c - d));
        }
    }
}

static inline void surface_even_point(double p[3], const struct element *e, double s, double t)
{
    int first = 1;
    if (e->vertices == 4) {
        double a[3], b[3], c[3];
        sub3(a, e->vertex[1], e->vertex[0]);
        sub3(b, e->vertex[2], e->vertex[0]);
        cross3(c, a, b);
        double share = 0.5 * length3(c) / e->area;
        first = s < share ? 1 : 2;
        s = first == 1 ? s / share : fmin((s - share) / (1 - share), 1);
    }
    double root = sqrt(s);
    for (int k = 0; k < 3; k++) {
        const double a = e->vertex[0][k], b = e->vertex[first][k], c = e->vertex[first + 1][k];
        p[k] = a + root * (b - a) + root * t * (c - b);
    }
}

/* Corner i of a surface, CORNER_INSET of the way to its centre: where two surfaces touch F has no
 * value at the corner itself. */
static inline void surface_corner(double p[3], const struct element *e, int i)
{
    for (int k = 0; k < 3; k++)
        p[k] = e->vertex[i][k] + CORNER_INSET * (e->centre[k] - e->vertex[i][k]);
}

#endif
