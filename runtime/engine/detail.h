/* detail.h - leaves made finer where particles can tell how light is spread over them.
 * SPDX-License-Identifier: MIT */
#ifndef DETAIL_H
#define DETAIL_H

#include "engine/solve.h"

/* Split the leaves of a linear solution, until about so many particles land (of all that do,
 * `landings`) on each no more than MEND_DETAIL. What links say is the same function as before, and
 * no link is added. A solution of constants stays as it is. Returns 0, or -1 when out of memory. */
int detail_leaves(struct solve *s, double landings);

#endif
