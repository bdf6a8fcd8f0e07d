/* exchange_fill.h - the values of blocks of exchange areas: worked out, by threads and ranks, and
 * put down as states where that is wanted.
 * SPDX-License-Identifier: MIT */
#ifndef EXCHANGE_FILL_H
#define EXCHANGE_FILL_H

#include "engine/exchange_areas.h"

/* Into m->values and the blocks' errors, from the links that blocks are of: links[block_count]. All
 * ranks then have all. Returns 0, or -1 on all of them: out of memory, or not wanted any more. */
int exchange_fill(struct exchange_areas *m, const struct link **links,
                  const struct exchange_aim *how);

#endif
