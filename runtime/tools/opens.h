/* opens.h - question: which element of a pair that holds a cluster is to be opened?
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_OPENS_H
#define TOOL_OPENS_H

#include "discussion.h"
#include "tools/can_split.h"

TOOL enum opens_answer tool_opens(struct discussion *d, double ratio, double min_share)
{
    const struct element *r = d->receiver, *s = d->emitter;
    double least = 4 * min_share * d->host->area;
    if (s->vertices)
        return s->radius > ratio * r->radius && s->area >= least && s->depth < CAN_SPLIT_DEPTH ? OPENS_EMITTER : OPENS_RECEIVER;
    if (r->vertices)
        return r->radius > ratio * s->radius && r->area >= least && r->depth < CAN_SPLIT_DEPTH ? OPENS_RECEIVER : OPENS_EMITTER;
    return r->radius > s->radius || (r->radius == s->radius && r->id <= s->id) ? OPENS_RECEIVER : OPENS_EMITTER;
}

#endif
