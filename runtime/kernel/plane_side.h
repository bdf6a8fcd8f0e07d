/* plane_side.h - how an element lies to another's support plane.
 * A corner nearer to the plane than `flat` lies in it, so elements that are coplanar or adjoin get
 * an exact answer.
 * SPDX-License-Identifier: MIT */
#ifndef KERNEL_PLANE_SIDE_H
#define KERNEL_PLANE_SIDE_H

#include "discussion.h"
#include "kernel/constants.h"

/* How near to a plane is in it, for this pair (m): rounding of the scene's coordinates, and of
 * the elements' corners. */
static inline double plane_side_flat(const struct element *r, const struct element *s,
                                     const struct host *host)
{
    return host->flat + PLANE_FLAT * (r->radius + s->radius);
}

/* What the sphere that holds e proves of its corners: 1, all are above `flat`; -1, all are below 0;
 * 0, nothing. `flat` is thousands of roundings of any coordinate, so that the computed heights of
 * the corners say the same. */
static inline int plane_side_proved(const struct element *e, const struct element *plane,
                                    double flat)
{
    const double h = height3(e->centre, plane->centre, plane->normal);
    return (h - e->radius > 2 * flat) - (h + e->radius < 0);
}

/* The lowest and the highest signed distance of the surface e from the plane of the surface
 * `plane` (m). */
static inline void plane_side_heights(const struct element *e, const struct element *plane,
                                      double *low, double *high)
{
    *low = *high = height3(e->vertex[0], plane->centre, plane->normal);
    for (int i = 1; i < e->vertices; i++) {
        double h = height3(e->vertex[i], plane->centre, plane->normal);
        if (h < *low)
            *low = h;
        if (h > *high)
            *high = h;
    }
}

/* 1: a corner of the surface e lies behind the plane of the surface `plane`. */
static inline int plane_side_behind(const struct element *e, const struct element *plane,
                                    double flat)
{
    for (int i = 0; i < e->vertices; i++)
        if (height3(e->vertex[i], plane->centre, plane->normal) < -flat)
            return 1;
    return 0;
}

/* 1: e, or the box of the cluster e, has parts on both sides of the plane of `plane`. A cluster
 * has no plane. */
static inline int plane_side_crosses(const struct element *e, const struct element *plane,
                                     double flat)
{
    if (plane->vertices == 0)
        return 0;
    double low, high;
    if (e->vertices) {
        plane_side_heights(e, plane, &low, &high);
    } else {
        double half = 0;
        for (int k = 0; k < 3; k++)
            half += 0.5 * fabs(plane->normal[k]) * (e->vertex[1][k] - e->vertex[0][k]);
        low = high = height3(e->centre, plane->centre, plane->normal);
        low -= half;
        high += half;
    }
    return low < -flat && high > flat;
}

#endif
