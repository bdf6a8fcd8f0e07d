/* larger.h - question: which element has the larger area? Since A_r F_rs = A_s F_sr, splitting the
 * larger is splitting the target of the larger form factor. Equal areas are told apart by identity,
 * so that a pair splits the same element both ways round. [Hanrahan et al. 1991, section 4]
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_LARGER_H
#define TOOL_LARGER_H

#include "discussion.h"

TOOL enum larger_answer tool_larger(struct discussion *d)
{
    const struct element *r = d->receiver, *s = d->emitter;
    return r->area > s->area || (r->area == s->area && r->id <= s->id) ? LARGER_RECEIVER
                                                                       : LARGER_EMITTER;
}

#endif
