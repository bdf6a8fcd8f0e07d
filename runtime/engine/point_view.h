/* point_view.h - what a point with a normal, a sensor, sees of each polygon of a scene.
 * SPDX-License-Identifier: MIT */
#ifndef POINT_VIEW_H
#define POINT_VIEW_H

#include "hierarchy/scene.h"

struct point_view {
    const struct scene *scene; /* borrowed */
    struct bvh tree;           /* over its faces */
    double near, blur; /* what is nearer to a plane lies in it; rounding of coordinates (m) */
};

/* Returns 0, or -1 when out of memory; then there is nothing to free. */
int point_view_open(struct point_view *v, const struct scene *scene, int threads);
void point_view_close(struct point_view *v);

/* row[inputs + 2]: the shares of the point's field of view, weighted with the cosine, in which it
 * sees each polygon's fronts, nothing, and black backs. They sum to 1. `normal` has length 1. Safe
 * from many threads at once. Returns 0, or -1 when out of memory. */
int point_view_row(const struct point_view *v, const double position[3], const double normal[3],
                   double *row);

#endif
