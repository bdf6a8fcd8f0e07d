/* environment.h - where the rays from a surface go.
 * SPDX-License-Identifier: MIT */
#ifndef ENVIRONMENT_H
#define ENVIRONMENT_H

#include "visibility/rays.h"

/* Of as many rays as stand here together, spread evenly over the surface and by the cosine over
 * its hemisphere. */
struct environment {
    /* what they meet first: a front, nothing, the black back of a one-sided face */
    int fronts, leaves, backs;
    /* from points inside a solid, as under a table leg, whatever they meet */
    int covered;
};

/* Points in side x side cells, each with so many rays: in the middles of the cells and of the rays'
 * rings, or anywhere in them, as rows may all miss a strip along them. What is smaller than a cell
 * may be missed. Few points with many rays share out well what goes far away, many with few find
 * what small feet cover, some with few how much is covered where it is much, and as many with one
 * whether anything is. */
struct environment_grid {
    int side, directions, anywhere;
};
static const struct environment_grid environment_coarse = {4, 64, 0},
                                     environment_middle = {32, 16, 1},
                                     environment_glance = {32, 1, 1},
                                     environment_fine = {64, 16, 1};

/* Thread-safe. The result depends on the surface, the scene and the points alone. */
struct environment environment_of(const struct rays *rays, const struct element *surface,
                                  struct environment_grid grid);

#endif
