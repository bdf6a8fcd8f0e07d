/* opens.h - question: which element of a pair that holds a cluster is to be opened? As clusters.h says.
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_OPENS_H
#define TOOL_OPENS_H

#include "discussion.h"

TOOL enum opens_answer tool_opens(struct discussion *d)
{
    const struct element *r = d->receiver, *s = d->emitter;
    if (r->vertices || s->vertices)
        return s->vertices ? OPENS_RECEIVER : OPENS_EMITTER;
    return r->radius > s->radius || (r->radius == s->radius && r->id <= s->id) ? OPENS_RECEIVER : OPENS_EMITTER;
}

#endif
