/* surface_point.h - point (s, t) of the unit square on a surface: evenly spread over a triangle or
 * a parallelogram.
 *
 * A triangle is the square folded at its diagonal, s drawn to its root so that area is kept; a quad
 * is bilinear, exactly even only as a parallelogram.
 * SPDX-License-Identifier: MIT */
#ifndef KERNEL_SURFACE_POINT_H
#define KERNEL_SURFACE_POINT_H

#include "discussion.h"

static inline void surface_point(double p[3], const struct element *e, double s, double t)
{
    if (e->vertices == 3)
        s = sqrt(s);
    for (int k = 0; k < 3; k++) {
        const double a = e->vertex[0][k], b = e->vertex[1][k], c = e->vertex[2][k],
                     d = e->vertex[3][k];
        p[k] = e->vertices == 3 ? a + s * (b - a) + s * t * (c - b)
                                : (1 - t) * (a + s * (b - a)) + t * (d + s * (c - d));
    }
}

#endif
