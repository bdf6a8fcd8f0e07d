/* light_bounds.h - x = source + rho H(x) where H is only known by ranges: what x is at the most,
 * and at the least.
 * SPDX-License-Identifier: MIT */
#ifndef LIGHT_BOUNDS_H
#define LIGHT_BOUNDS_H

#include "engine/light_ranges.h"

enum light_bounds_of {
    LIGHT_MOST,
    LIGHT_LEAST,
    LIGHT_MOST_LINKED, /* the same, were each link's V right at all its points */
    LIGHT_LEAST_LINKED
};

struct light_bounds {
    struct light_ranges *ranges; /* weights and order of shares are written */
    enum light_bounds_of of;
    const double *source; /* [element], leaves are read */
    const double *rho;    /* [face] */
    double rho_most;      /* of rho, below 1 */
    const double *start;  /* [element]: a guess; any will do */
    double *x;            /* [element]: the result, of uncovered leaves, and what is above them */
    double *irradiance;   /* [element]: the H that goes with x; NULL: nobody asks */
};

/* Solve. Returns 0, or -1 when out of memory. */
int light_bounds_solve(const struct light_bounds *b);

#endif
