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

/* Thread-safe. The result depends on the surface and the scene alone. */
struct environment environment_of(const struct rays *rays, const struct element *surface);

#endif
