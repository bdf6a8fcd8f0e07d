/* hemisphere.h - directions above a surface, spread by the cosine: a spiral of golden angles.
 *
 * Direction m of n has the radius sqrt((m + 1/2) / n) on the unit disc, so that each stands for the
 * same share of the irradiance.
 * [H. Vogel 1979, A better way to construct the sunflower head, on the disc; lifted to the
 * hemisphere as Nusselt's analog]
 * SPDX-License-Identifier: MIT */
#ifndef KERNEL_HEMISPHERE_H
#define KERNEL_HEMISPHERE_H

#include "geometry.h"

struct hemisphere {
    /* the normal and two unit vectors across it, u square to the axis that is most across it */
    double n[3], u[3], v[3];
};

static inline struct hemisphere hemisphere_over(const double n[3])
{
    struct hemisphere h = {{n[0], n[1], n[2]}, {0, 0, 0}, {0, 0, 0}};
    int axis = fabs(n[0]) <= fabs(n[1])   ? fabs(n[0]) <= fabs(n[2]) ? 0 : 2
               : fabs(n[1]) <= fabs(n[2]) ? 1
                                          : 2;
    h.u[axis] = 1;
    cross3(h.v, n, h.u);
    double size = length3(h.v);
    for (int k = 0; k < 3; k++)
        h.v[k] /= size;
    cross3(h.u, h.v, n);
    return h;
}

/* Direction m of `count`; `turn`: by which part of a golden angle the whole spiral is turned;
 * `ring`: where in its ring it is, in [0, 1). */
static inline void hemisphere_direction_in(double out[3], const struct hemisphere *h, int m,
                                           int count, double turn, double ring)
{
    double angle = 2.39996322972865332 * (m + turn), r = sqrt((m + ring) / count),
           z = sqrt(1 - r * r);
    for (int k = 0; k < 3; k++)
        out[k] = z * h->n[k] + r * (cos(angle) * h->u[k] + sin(angle) * h->v[k]);
}

/* The same in the middle of its ring. */
static inline void hemisphere_direction(double out[3], const struct hemisphere *h, int m, int count,
                                        double turn)
{
    hemisphere_direction_in(out, h, m, count, turn, 0.5);
}

#endif
