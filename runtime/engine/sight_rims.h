/* sight_rims.h - what a point sees of a convex polygon past convex solids, by the rims of their
 * shadows.
 * SPDX-License-Identifier: MIT */
#ifndef SIGHT_RIMS_H
#define SIGHT_RIMS_H

#include "engine/sight_bodies.h"

/* sight_factor past them, placed in the raised plane; -1: the point is not told. */
double sight_rims_past(const struct sight *sight, const double x[3], const double n[3], double up,
                       const struct sight_bodies *bodies, double *whole);

#endif
