/* cluster_facing.h - how much of an element may face a direction (m2): its area times the largest
 * cosine that a normal of its cone may have with it. Of a cluster's children the sum is nearer to
 * the truth than of the cluster itself.
 * Fails: for directions beside v, by an angle whose sine is `slope`, what turns away from v gets c
 * + slope where it may show up to sqrt(1 - slope^2) c + sqrt(1 - c^2) slope: so it is as small as
 * sqrt(1 - slope^2) of the truth (3/4 at 1.5 radii), but 0 only where that is.
 * [Smits, Arvo, Greenberg 1994, the sums of alpha links, here over cones and not over faces]
 * SPDX-License-Identifier: MIT */
#ifndef KERNEL_CLUSTER_FACING_H
#define KERNEL_CLUSTER_FACING_H

#include "discussion.h"

/* The area of e that may face direction v (unit), or one that differs from it by an angle whose
 * sine is at most `slope`. */
static inline double cluster_facing(const struct element *e, const double v[3], double slope)
{
    double c = dot3(e->normal, v), across = 1 - c * c, sine = 1 - e->cone * e->cone;
    if (c < e->cone) /* the normal of the cone that turns to v most */
        c = c * e->cone + (across > 0 && sine > 0 ? sqrt(across * sine) : 0);
    else
        c = 1;
    if (e->vertices)
        c = dot3(e->normal, v);
    c += slope;
    return e->area * (c < 0 ? 0 : c < 1 ? c : 1);
}

/* The same of an element by its children, when it is a cluster. */
static inline double cluster_facing_parts(const struct element *e, const struct element *all,
                                          const double v[3], double slope)
{
    double sum = 0;
    if (e->vertices)
        return cluster_facing(e, v, slope);
    for (int i = 0; i < e->children; i++)
        sum += cluster_facing(&all[e->child + (uint32_t)i], v, slope);
    return sum;
}

#endif
