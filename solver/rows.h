/* rows.h - the row of a leaf: the sum of F V over its own links and its ancestors', and what it is scaled to.
 * SPDX-License-Identifier: MIT */
#ifndef ROWS_H
#define ROWS_H

#include "solve.h"

/* Call visit(context, s, leaf, row) for the leaves below element e, in their order. */
void rows_visit(const struct solve *s, uint32_t e, void (*visit)(void *context, const struct solve *s, uint32_t leaf, double row),
                void *context);

/* Measure all rows and set row_scale, row_gift and what solve.h reports of rows, as options.closure says. */
void rows_scale(struct solve *s);

#endif
