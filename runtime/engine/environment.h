/* factor_sky.h - what becomes of the light that a row of view factors lacks.
 * SPDX-License-Identifier: MIT */
#ifndef FACTOR_SKY_H
#define FACTOR_SKY_H

#include "engine/exchange_areas.h"

/* Where the rays from a row's faces went that met no front: shares of its area. */
struct factor_sky {
    float leaves;  /* out of the scene */
    float lost;    /* onto the black back of a one-sided face */
    float buried;  /* they start inside a solid, as under a table leg */
    unsigned char asked; /* 0: nobody asked, and nothing above is known */
};

/* Ask for every row that is off 1 by more than `tolerance` (0: for all of them). sums: of the rows, without unit.
 * sky: [m->inputs], zero. */
void factor_sky_ask(struct factor_sky *sky, const struct factor_matrix *m, const double *sums, double tolerance, int threads);

/* Must the row sum to 1? Nothing that was asked contradicts it. */
int factor_sky_closed(const struct factor_sky *sky);

#endif
