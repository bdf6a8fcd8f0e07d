/* balance.h - the one linear equation that is solved over the links, x = source + rho F V x.
 * SPDX-License-Identifier: MIT */
#ifndef BALANCE_H
#define BALANCE_H

#include "engine/solve.h"

/* Radiosity (source: exitance) or whatever else travels as light does. */
struct balance {
    uint32_t bands;
    double *value, *irradiance; /* [element * bands + band]: start and result; clusters are left alone */
    const double *source;       /* [face * bands + band], or [element * bands + band] (leaves are read) */
    const double *reflectance;  /* [face * bands + band] */
    int by_element;             /* which of the two the source is given by */
    double tolerance;           /* relative error that iteration may leave */

    int sweeps, converged;      /* of this solve */
    double residual;            /* of the last sweep: sum A |dx| / sum A x over leaves */
};

/* Sweep until the error that iteration leaves is below the tolerance; row_scale, row_above and row_gift are set (rows.h).
 * Returns 0, or -1 when out of memory. */
int balance_solve(struct solve *s, struct balance *x);

/* The weight of child j in the mean radiosity of e: its share of the exposed area, or of all when none is exposed. */
double balance_share(const struct solve *s, uint32_t j, uint32_t e);

#endif
