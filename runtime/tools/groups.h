/* groups.h - question: which of two surfaces are flat groups of faces, which are opened and not
 * split (tools/group_level.h)? D: derived here.
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_GROUPS_H
#define TOOL_GROUPS_H

#include "discussion.h"

TOOL enum groups_answer tool_groups(struct discussion *d)
{
    int r = d->receiver->group != 0, s = d->emitter->group != 0;
    return r ? s ? GROUPS_BOTH : GROUPS_RECEIVER : s ? GROUPS_EMITTER : GROUPS_NEITHER;
}

#endif
