/* reach.h - how far surfaces reach over planes.
 * SPDX-License-Identifier: MIT */
#ifndef REACH_H
#define REACH_H

#include "discussion.h"

/* How far corners reach in front of a plane, and behind: no less than *high and *low say already.
 */
static inline void polygon_reach(const double (*vertex)[3], uint32_t count, const double on[3],
                                 const double normal[3], double *high, double *low)
{
    for (uint32_t i = 0; i < count; i++) {
        const double height = height3(vertex[i], on, normal);
        *high = height > *high ? height : *high;
        *low = height < *low ? height : *low;
    }
}

/* How far the corners of a surface reach in front of another one's plane, and behind. */
static inline void element_reach(const struct element *plane, const struct element *e, double *high,
                                 double *low)
{
    polygon_reach((const double(*)[3])e->vertex, e->vertices, plane->vertex[0], plane->normal, high,
                  low);
}

/* A box around a surface, which a sphere is known around, or that of a cluster. */
static inline void element_box(const struct element *e, double box[2][3])
{
    for (int k = 0; k < 3; k++) {
        box[0][k] = e->vertices ? e->centre[k] - e->radius : e->vertex[0][k];
        box[1][k] = e->vertices ? e->centre[k] + e->radius : e->vertex[1][k];
    }
}

/* How far a box, from its low corner to its high one, reaches in front of a plane, and behind. */
static inline void box_reach(const double (*box)[3], const double on[3], const double normal[3],
                             double *high, double *low)
{
    *high = *low = 0;
    for (int k = 0; k < 3; k++) {
        const double from = normal[k] * (box[0][k] - on[k]), to = normal[k] * (box[1][k] - on[k]);
        *high += from > to ? from : to;
        *low += from < to ? from : to;
    }
}

#endif
