/* opens.h - question: which element of a pair that holds a cluster is to be opened? The one with
 * the larger bounding sphere, since it keeps the two from being apart; but a surface only while it
 * is more than `ratio` times as large as the cluster and its parts stay above `min_share` of the
 * scene's area, else the cluster. So a wall beside a chair is cut into parts the size of the chair,
 * and not the chair into faces that each see the whole wall.
 * [Smits, Arvo, Greenberg 1994, section 4; the surface's turn: derived here]
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_OPENS_H
#define TOOL_OPENS_H

#include "discussion.h"
#include "kernel/wider.h"
#include "tools/can_split.h"

/* May the surface be opened, and is it the larger? */
static inline int opens_surface(const struct element *surface, const struct element *cluster,
                                double ratio, double least)
{
    return surface->radius > ratio * cluster->radius && surface->area >= least
           && surface->depth < CAN_SPLIT_DEPTH;
}

TOOL enum opens_answer tool_opens(struct discussion *d, double ratio, double min_share)
{
    const struct element *r = d->receiver, *s = d->emitter;
    double least = 4 * min_share * d->host->area;
    if (s->vertices)
        return opens_surface(s, r, ratio, least) ? OPENS_EMITTER : OPENS_RECEIVER;
    if (r->vertices)
        return opens_surface(r, s, ratio, least) ? OPENS_RECEIVER : OPENS_EMITTER;
    return wider(r, s) ? OPENS_RECEIVER : OPENS_EMITTER;
}

#endif
