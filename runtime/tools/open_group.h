/* open_group.h - question: which of two surfaces, one of which is a flat group of faces (tools/group_level.h), is to be opened?
 * The group; of two groups the one with the larger radius, and of two of one size the one with the smaller identity, so
 * that a pair opens the same one both ways round.
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_OPEN_GROUP_H
#define TOOL_OPEN_GROUP_H

#include "discussion.h"
#include "tools/group_level.h"

TOOL enum open_group_answer tool_open_group(struct discussion *d)
{
    const struct element *r = d->receiver, *s = d->emitter;
    if (!group_level_group(s))
        return OPEN_GROUP_RECEIVER;
    if (!group_level_group(r))
        return OPEN_GROUP_EMITTER;
    return r->radius > s->radius || (r->radius == s->radius && r->id <= s->id) ? OPEN_GROUP_RECEIVER : OPEN_GROUP_EMITTER;
}

#endif
