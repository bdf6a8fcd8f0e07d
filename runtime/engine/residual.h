/* residual.h - how far the radiosity of a leaf is from what its links would give at single points
 * of it.
 * SPDX-License-Identifier: MIT */
#ifndef RESIDUAL_H
#define RESIDUAL_H

#include "engine/operator.h"

/* The discretization residual of a leaf (W/m2), the band where it is largest. */
struct leaf_residual {
    double all;     /* of all its links, its ancestors' among them */
    double guarded; /* of those alone that a guard kept from being split (LINK_GUARDED) */
    uint32_t links; /* how many it has */
};

/* With B = radiosity[element * bands + band], of which the separable links were last sent.
 * Thread-safe. */
struct leaf_residual residual_of_leaf(const struct light_operator *op, const double *radiosity,
                                      uint32_t leaf);

#endif
