/* deal.h - the discussions of a round, dealt out to ranks of which each has all elements and links.
 *
 * Unlike shares.h, where each rank goes on with the pairs of its receivers alone, here all ranks
 * have the same queue and carry out the same decisions; what takes time, the discussions, they
 * share by index. Invariant: afterwards all have what one process would have, at the same places.
 * SPDX-License-Identifier: MIT */
#ifndef DEAL_H
#define DEAL_H

#include "engine/refine.h"

/* Discuss the first `count` pairs of the round, this rank its part, and learn of the others' what
 * came of them. Returns 0, or -1 on all ranks when any is out of memory. */
int deal_round(const struct refinement *r, size_t count);

#endif
