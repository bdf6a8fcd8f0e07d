/* dominates.h - question: does one surface hold more than `share` of what an element sends, A B?
 * Then the element is that surface, with something beside it, and to open it is what helps. none:
 * neither; both: both do.
 *
 * For shares of a half and more it is found by going down to the child that sends most: what holds
 * more than half of the whole holds more than half of every cluster on its way. A surface dominates
 * itself.
 * [Smits, Arvo, Greenberg 1994, section 4, for links from a cluster's surfaces; the walk: derived
 * here]
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_DOMINATES_H
#define TOOL_DOMINATES_H

#include "discussion.h"

OUTLINE int dominates_one(const struct element *e, const struct element *all, double share)
{
    double least = share * e->area * e->radiosity;
    while (!e->vertices) {
        const struct element *most = &all[e->child];
        for (int i = 1; i < e->children; i++) {
            const struct element *x = &all[e->child + (uint32_t)i];
            if (x->area * x->radiosity > most->area * most->radiosity)
                most = x;
        }
        if (!(most->area * most->radiosity > least))
            return 0;
        e = most;
    }
    return 1;
}

TOOL enum dominates_answer tool_dominates(struct discussion *d, double share)
{
    /* NULL: there are no clusters */
    const struct element *all = d->host->elements ? *d->host->elements : NULL;
    int r = dominates_one(d->receiver, all, share), s = dominates_one(d->emitter, all, share);
    return r && s ? DOMINATES_BOTH
           : r    ? DOMINATES_RECEIVER
           : s    ? DOMINATES_EMITTER
                  : DOMINATES_NONE;
}

#endif
