/* linear_transport.h - transport.h's equation for functions linear over each surface.
 * SPDX-License-Identifier: MIT */
#ifndef LINEAR_TRANSPORT_H
#define LINEAR_TRANSPORT_H

#include "engine/linear_links.h"
#include "engine/transport.h"

/* Slopes beside the means of a transport. */
struct linear_transport {
    struct transport *means; /* bands, value, irradiance, ... and what becomes of the solve */
    /* [(element * bands + band) * 2], in the elements' bases: start and result */
    double *value, *irradiance;
};

/* Sweep from the means and slopes as they are until what iteration leaves is within the tolerance;
 * row scales are set for these links (row_sums.h, linear_links_scale). Returns 0, -1 when out of
 * memory or stopped by `watch`, or 1 when changes grow and kernels may be negative. */
int linear_transport_solve(const struct light_operator *op, const struct linear_links *l,
                           struct linear_transport *x);

#endif
