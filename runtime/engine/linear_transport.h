/* linear_transport.h - transport.h's equation for functions linear over each surface.
 * SPDX-License-Identifier: MIT */
#ifndef LINEAR_TRANSPORT_H
#define LINEAR_TRANSPORT_H

#include "engine/linear_links.h"
#include "engine/transport.h"

/* Slopes beside the means of a transport. */
struct linear_transport {
    struct transport *means; /* bands, value, irradiance, ... and what becomes of the solve */
    /* [(element * bands + band) * 3]: what the element sends in its basis; the mean is less by what
     * is error in the leaves' rows (linear_links.c). Start and result */
    double *value;
    double *irradiance; /* [(element * bands + band) * 2]: slopes */
};

/* Let elements send the means that x has, with the slopes that the leaves have; means and slopes
 * of what has parts are projections then. */
void linear_transport_start(const struct light_operator *op, const struct linear_links *l,
                            const struct linear_transport *x);

/* Sweep from the means and slopes as they are until what iteration leaves is within the tolerance;
 * row scales are set for these links (row_sums.h, linear_links_scale). Returns 0, -1 when out of
 * memory or stopped by `watch`, or 1 when changes grow and kernels may be negative. */
int linear_transport_solve(const struct light_operator *op, const struct linear_links *l,
                           struct linear_transport *x);

#endif
