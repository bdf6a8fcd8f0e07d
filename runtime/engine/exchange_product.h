/* exchange_product.h - the matrix of exchange areas times columns, values kept or not.
 * SPDX-License-Identifier: MIT */
#ifndef EXCHANGE_PRODUCT_H
#define EXCHANGE_PRODUCT_H

#include "engine/exchange_areas.h"

/* y[inputs][columns] = sum over j of A_i F_ij x[j][columns] (m2 times x), of the rows that are
 * asked for; others may lack something. Where values are not kept, they are computed, tile by tile,
 * from the refinement that the areas were opened with. The same bits for any number of threads.
 * Returns 0, or -1 when out of memory. */
int exchange_product(const struct exchange_areas *m, int threads, uint32_t columns, const double *x,
                     double *y);

#endif
