/* sight_limits.h - how near the exchange area of two faces past others has to come, and what may be
 * spent on it.
 * SPDX-License-Identifier: MIT */
#ifndef SIGHT_LIMITS_H
#define SIGHT_LIMITS_H

#include <math.h>

#include "engine/exchange_tree.h"

/* How near to come: the error of F, of itself, or of `floor` where F is smaller; with at most so
 * many pieces. */
struct sight_limits {
    double tolerance, floor;
    int pieces;
    int list; /* the most that can stand between */
    int many; /* 1: rules that tell enough are believed */
};

/* Is the error of an exchange area (m2) as small as asked for? `least`: the smaller area. */
static inline int sight_enough(const struct sight_limits *limits, double error, double value,
                               double least)
{
    return error <= limits->tolerance * fmax(value, limits->floor * least);
}

/* Limits for a scene of so many polygons, and the faces that these are cut into. */
struct sight_limits sight_limits_for(double tolerance, uint32_t polygons, uint32_t faces);

/* Of these, what two faces need that are parts of polygons. */
struct sight_limits sight_limits_of(const struct sight_limits *limits,
                                    const struct exchange_tree *t, const struct element *r,
                                    const struct element *s);

#endif
