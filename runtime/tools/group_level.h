/* group_level.h - question: are both surfaces faces or parts of faces, or are there flat groups of
 * faces among them?
 *
 * A host may group coplanar faces and give the group as a surface: the rectangle around them,
 * marked `group`, whose children are such groups or faces. Its rectangle holds whatever its faces
 * hold, so what the shaft between two rectangles says precisely is true of all pairs of their
 * faces; its form factor is nobody's. few: a group is among them, and none that holds groups. D:
 * derived here.
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_GROUP_LEVEL_H
#define TOOL_GROUP_LEVEL_H

#include "discussion.h"

/* Does the group e hold groups? */
static inline int group_level_high(const struct element *e, const struct host *host)
{
    if (!e->group || !host->elements)
        return 0;
    const struct element *child = *host->elements + e->child;
    for (int c = 0; c < e->children; c++)
        if (child[c].group)
            return 1;
    return 0;
}

TOOL enum group_level_answer tool_group_level(struct discussion *d)
{
    const struct element *r = d->receiver, *s = d->emitter;
    if (!r->group && !s->group)
        return GROUP_LEVEL_FACES;
    return group_level_high(r, d->host) || group_level_high(s, d->host) ? GROUP_LEVEL_MANY
                                                                        : GROUP_LEVEL_FEW;
}

#endif
