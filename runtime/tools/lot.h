/* lot.h - question: is this pair among those that were drawn? The share `share` of all pairs is, by
 * a hash of both identities: the same pairs in every run and both ways round, and whatever else is
 * asked. For studies of expensive tools on large scenes: what is counted of the drawn holds for
 * all, within its confidence interval. [D: derived here]
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_LOT_H
#define TOOL_LOT_H

#include "discussion.h"
#include "kernel/hash.h"

TOOL enum lot_answer tool_lot(struct discussion *d, double share)
{
    uint64_t r = d->receiver->id, s = d->emitter->id,
             x = hash64((r < s ? r : s) * HASH_STEP + (r < s ? s : r));
    return (double)(x >> 11) * (1 / 9007199254740992.0) < share ? LOT_DRAWN : LOT_BLANK;
}

#endif
