/* dark_sides.h - the sides of two-sided faces that no light comes to: the insides of solids.
 * SPDX-License-Identifier: MIT */
#ifndef DARK_SIDES_H
#define DARK_SIDES_H

#include "util/ranks.h"
#include "visibility/rays.h"

/* dark[face]: 1 of a side of a two-sided face that no face with exitance[face] > 0 sees, directly
 * or by way of others; what is not sure is 0. All 0 where nothing emits. precision: of coordinates,
 * relative (scene.h). The same for any number of threads and ranks, which
 * share the work. Returns 0, or -1 when out of memory. */
int dark_sides_find(const struct rays *rays, const struct hierarchy *h, const double *exitance,
                    double precision, struct ranks *ranks, int threads, uint8_t *dark);

#endif
