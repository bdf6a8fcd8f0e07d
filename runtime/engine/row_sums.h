/* rows.h - the row of a leaf: the sum of F V over its own links and its ancestors', and what it is scaled to.
 * SPDX-License-Identifier: MIT */
#ifndef ROWS_H
#define ROWS_H

#include "engine/solve.h"

/* Measure all rows and set row_scale, row_above, row_gift and what solve.h reports of rows, as options.closure says. */
void rows_scale(struct solve *s);

#endif
