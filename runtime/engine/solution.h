/* solution.h - radiosity on a hierarchy: what the solver leaves and the writers read.
 * SPDX-License-Identifier: MIT */
#ifndef SOLUTION_H
#define SOLUTION_H

#include <stdint.h>
#include "hierarchy/hierarchy.h"
#include "hierarchy/scene.h"

/* Values are constant over a leaf. Radiosity is the mean over the part of an element that is not covered by a
 * solid; irradiance the mean over all of it. */
struct solution {
    const struct scene *scene;         /* borrowed */
    const struct hierarchy *hierarchy; /* borrowed */
    uint32_t bands;                    /* 1 or 3 */
    const double *radiosity;           /* B, W/m2: [element * bands + band] */
    const double *irradiance;          /* H, W/m2: likewise, what ancestors receive included */
};

#endif
