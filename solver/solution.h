/* solution.h - radiosity on a hierarchy: what the solver leaves and the writers read.
 * SPDX-License-Identifier: MIT */
#ifndef SOLUTION_H
#define SOLUTION_H

#include <stdint.h>
#include "hierarchy.h"
#include "scene.h"

/* Values are constant over a leaf; an inner element holds the area mean of its children. */
struct solution {
    const struct scene *scene;         /* borrowed */
    const struct hierarchy *hierarchy; /* borrowed */
    uint32_t bands;                    /* 1 or 3 */
    const double *radiosity;           /* B, W/m2: [element * bands + band] */
    const double *irradiance;          /* H, W/m2: likewise, what ancestors receive included */
};

#endif
