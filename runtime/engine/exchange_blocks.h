/* exchange_blocks.h - the exchange areas of a block of pairs of faces, from the link that stands
 * for them.
 * SPDX-License-Identifier: MIT */
#ifndef EXCHANGE_BLOCKS_H
#define EXCHANGE_BLOCKS_H

#include "engine/exchange_clear.h"
#include "engine/exchange_shadow.h"
#include "engine/exchange_sight.h"
#include "engine/refine.h"

/* One thread's room. */
struct exchange_scratch {
    struct clear_scratch clear;
    struct shadow_scratch shadow;
    struct sight_scratch sight;
};

/* `most` faces of a side. Returns 0, or -1 when out of memory; close is fine then too. */
int exchange_scratch_open(struct exchange_scratch *scratch, uint32_t most,
                          const struct sight_limits *limits);
void exchange_scratch_close(struct exchange_scratch *scratch);

/* out[rows][columns]: A_i F_ij (m2), none above the smaller area. Returns the largest error
 * estimated of any (m2); 0 where nobody estimates: of a clear view, and of groups. */
double exchange_block_fill(const struct exchange_faces *faces, const struct exchange_pair *pair,
                           const struct link *link, struct exchange_scratch *scratch, double *out);

#endif
