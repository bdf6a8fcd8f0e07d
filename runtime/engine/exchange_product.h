/* exchange_product.h - the matrix of exchange areas times columns, values kept or not.
 * SPDX-License-Identifier: MIT */
#ifndef EXCHANGE_PRODUCT_H
#define EXCHANGE_PRODUCT_H

#include "engine/exchange_areas.h"

/* y[inputs][columns] = sum over j of A_i F_ij x[j][columns] (m2 times x), of the rows that are
 * asked for; others may lack something. Values that are not kept are computed, tile by tile. The
 * same bits for any number of threads, and however many values are kept. Returns 0, or -1 when out
 * of memory. */
int exchange_product(const struct exchange_areas *m, int threads, uint32_t columns, const double *x,
                     double *y);

/* sums[inputs]: the same for one column of ones (x NULL), or for x[inputs]. */
int exchange_sums(const struct exchange_areas *m, int threads, const double *x, double *sums);

#endif
