/* exchange_horizon.h - the exchange areas of a block of pairs past one convex solid.
 * SPDX-License-Identifier: MIT */
#ifndef EXCHANGE_HORIZON_H
#define EXCHANGE_HORIZON_H

#include "engine/exchange_clear.h"
#include "engine/exchange_sight.h"

/* the most faces of a block's longer side; measured: faster than 8 */
enum { HORIZON_SIDE = 16 };

/* One thread's room; malloc'd, as free frees it. NULL: out of memory. */
struct horizon;
struct horizon *horizon_open(void);

/* values[rows][across]: of the pair's rows and columns (m2), which lie in `r` and `s`, between
 * which stand faces of the list. Returns 0, and writes nothing that counts, when these are not of
 * one convex solid, or more is to be known; else 1, and *most is the largest error estimated of
 * any, as a share of the smaller area, or what it was. */
int horizon_block(const struct exchange_faces *faces, const struct exchange_pair *pair,
                  const struct element *r, const struct element *s, const struct shaft *shaft,
                  const struct sight_list *list, struct horizon *horizon,
                  struct sight_scratch *scratch, double *values, size_t across, double *most);

#endif
