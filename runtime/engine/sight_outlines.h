/* sight_outlines.h - what a point sees of a convex polygon past surfaces made of many faces, by
 * their outlines.
 * SPDX-License-Identifier: MIT */
#ifndef SIGHT_OUTLINES_H
#define SIGHT_OUTLINES_H

#include "engine/sight_between.h"

/* sight_factor past what stands between. */
double sight_past(const struct sight *sight, const double x[3], const double n[3], double up,
                  struct sight_between *between, double *whole);

#endif
