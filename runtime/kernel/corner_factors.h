/* corner_factors.h - the form factor from a few points of the receiver: its centre and its corners,
 * these CORNER_INSET of the way to the centre (kernel/surface_point.h).
 * SPDX-License-Identifier: MIT */
#ifndef KERNEL_CORNER_FACTORS_H
#define KERNEL_CORNER_FACTORS_H

#include "discussion.h"
#include "kernel/point_factor.h"
#include "kernel/surface_point.h"

/* f[0]: the centre's, then the corners'. *q becomes the part of s in front of r. */
static inline void corner_factors_in(const struct element *r, const struct element *s,
                                     struct polygon *q, double f[5])
{
    double x[5][3];
    point_factor_clip(q, r, s);
    for (int k = 0; k < 3; k++)
        x[0][k] = r->centre[k];
    for (int i = 0; i < r->vertices; i++)
        surface_corner(x[1 + i], r, i);
    point_factors_at(1 + r->vertices, (const double(*)[3])x, r, s, q, f);
}

/* The same. Returns 0 when no part of s is in front of r. */
static inline int corner_factors(const struct element *r, const struct element *s, double f[5])
{
    struct polygon q;
    corner_factors_in(r, s, &q, f);
    return q.n > 0;
}

/* How far f over a surface of so many corners is from its best linear function, by f at its centre
 * and corners, as above, and its mean. f[0] to f[corners] */
static inline double corner_bend(const double f[5], int corners, double mean)
{
    double sum = 0, twist = 0;
    for (int i = 1; i <= corners; i++)
        sum += f[i] / corners;
    if (corners == 4)
        twist = 0.25 * fabs(f[1] - f[2] + f[3] - f[4]);
    double bulge = (2 / 3.0) * fabs(f[0] - sum);
    double missed = fabs(mean - (2 / 3.0) * f[0] - (1 / 3.0) * sum);
    twist = twist > bulge ? twist : bulge;
    return twist > missed ? twist : missed;
}

#endif
