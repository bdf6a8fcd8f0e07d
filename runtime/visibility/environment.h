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

/* The points stand on a grid of side x side; what is smaller than a cell may be missed. */
enum { ENVIRONMENT_COARSE = 4, ENVIRONMENT_FINE = 16 };

/* Thread-safe. The result depends on the surface, the scene and `side` alone. */
struct environment environment_of(const struct rays *rays, const struct element *surface, int side);

#endif
