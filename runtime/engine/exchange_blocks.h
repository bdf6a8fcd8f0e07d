/* exchange_blocks.h - the exchange areas of a block of pairs of faces, from the link that stands
 * for them.
 * SPDX-License-Identifier: MIT */
#ifndef EXCHANGE_BLOCKS_H
#define EXCHANGE_BLOCKS_H

#include "engine/exchange_clear.h"
#include "engine/exchange_horizon.h"
#include "engine/exchange_shadow.h"
#include "engine/exchange_sight.h"
#include "engine/refine.h"

/* One thread's room. */
struct exchange_scratch {
    struct shadow_scratch shadow;
    struct sight_scratch sight;
    struct horizon *horizon;
};

/* Returns 0, or -1 when out of memory; close is fine then too. */
int exchange_scratch_open(struct exchange_scratch *scratch, const struct sight_limits *limits);
void exchange_scratch_close(struct exchange_scratch *scratch);

/* out[rows][columns]: A_i F_ij (m2), none above the smaller area. Returns the largest error
 * estimated of any, as a share of the smaller area; 0 where nobody estimates: of a clear view. */
double exchange_block_fill(const struct exchange_faces *faces, const struct exchange_pair *pair,
                           const struct link *link, struct exchange_scratch *scratch, double *out);

/* Is it proved that nothing stands between the two elements of the link? */
int exchange_link_proved(const struct link *link);

/* Is the link one of groups in a clear view of each other? A block of it is made anew in next to no
 * time, and so is one of its lines (exchange_clear.h). */
int exchange_link_clear(const struct exchange_tree *tree, const struct link *link);

#endif
