/* handed_down.h - question: are both whole faces; or has the pair above this one left a list of the
 * few faces that may stand between (terms/blockers.h)? Of whole faces a shaft costs a walk through
 * the scene, which all pairs below share; with a list it costs a few plane tests. Such shafts are
 * worth asking before any ray, others after some. It costs nothing itself.
 * A pair discussed again has no list any more; where its visibility was known exactly there was
 * one, and the pairs below will want it. [Haines & Wallace 1994 for lists that children inherit;
 * the question: derived here]
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_HANDED_DOWN_H
#define TOOL_HANDED_DOWN_H

#include "discussion.h"

TOOL enum handed_down_answer tool_handed_down(struct discussion *d)
{
    if (d->receiver->vertices && d->emitter->vertices && d->receiver->depth == 0
        && d->emitter->depth == 0)
        return HANDED_DOWN_WHOLE;
    if (d->terms.visibility_level == VISIBILITY_EXACT)
        return HANDED_DOWN_LIST;
    return d->blockers && d->blockers->known != BLOCKERS_UNKNOWN ? HANDED_DOWN_LIST
                                                                 : HANDED_DOWN_NONE;
}

#endif
