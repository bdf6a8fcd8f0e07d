/* lot.h - question: is this pair among those that were drawn? The share `share` of all pairs is, by a hash of both
 * identities: the same pairs in every run and both ways round, and whatever else is asked. For studies of expensive tools
 * on large scenes: what is counted of the drawn holds for all, within its confidence interval. [D: derived here]
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_LOT_H
#define TOOL_LOT_H

#include "discussion.h"

TOOL enum lot_answer tool_lot(struct discussion *d, double share)
{
    uint64_t r = d->receiver->id, s = d->emitter->id, x = (r < s ? r : s) * 0x9e3779b97f4a7c15u + (r < s ? s : r);
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
    x = (x ^ x >> 27) * 0x94d049bb133111ebu;
    x ^= x >> 31;
    return (double)(x >> 11) * (1 / 9007199254740992.0) < share ? LOT_DRAWN : LOT_BLANK;
}

#endif
