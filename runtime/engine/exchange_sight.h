/* exchange_sight.h - the exchange area of two faces, or parts of faces, past what stands between
 * them, and how far it may be wrong.
 * SPDX-License-Identifier: MIT */
#ifndef EXCHANGE_SIGHT_H
#define EXCHANGE_SIGHT_H

#include "engine/sight_cubature.h"
#include "engine/sight_lists.h"

/* A_r F_rs (m2), no more than if nothing stood between; *error: the error estimated (m2). `among`:
 * of a pair that holds this one; NULL: nobody has looked. `again`: of a row that did not add up, so
 * rules that tell enough are not believed. */
double sight_pair(const struct element *r, const struct element *s,
                  const struct exchange_tree *tree, const struct sight_list *among,
                  struct sight_scratch *scratch, int again, double *error);

#endif
