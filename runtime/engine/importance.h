/* importance.h - what a view makes of the light that leaves each place.
 * SPDX-License-Identifier: MIT */
#ifndef IMPORTANCE_H
#define IMPORTANCE_H

#include "engine/solve.h"

/* Before the first refinement: what the view sees of every face is all that counts. Returns 0, or -1 when out of memory. */
int importance_start(struct solve *s);

/* Solve for importance over the links as they are (rows scaled) and let the oracles see it; changed[e] becomes 1 where it
 * grew. Returns 0, or -1 when out of memory. */
int importance_solve(struct solve *s);

void importance_free(struct solve *s);

#endif
