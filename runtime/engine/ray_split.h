/* ray_split.h - did links bring more for their rays than particles would have?
 * SPDX-License-Identifier: MIT */
#ifndef RAY_SPLIT_H
#define RAY_SPLIT_H

#include "engine/operator.h"
#include "particles/particles.h"

/* Squared error over places, each as a share of the light there, the places weighed by light: what
 * links have, and what particles would have of as many rays as the links took. */
struct ray_split {
    double links, particles;
};

/* By what particles say of the irradiances [element * bands + band] of all elements (W/m2). The
 * tally has counts of leaves. Returns 0, or -1 when out of memory. */
int ray_split_measure(const struct light_operator *op, const struct tally *tally,
                      const double *irradiance, uint64_t link_rays, struct ray_split *split);

#endif
