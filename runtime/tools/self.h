/* self.h - question: is the pair an element and itself? A surface is flat and gives itself nothing;
 * the parts of a cluster light each other, and only opening it on both sides makes sense.
 * [Hanrahan et al. 1991, section 4; Smits, Arvo, Greenberg 1994]
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_SELF_H
#define TOOL_SELF_H

#include "discussion.h"

TOOL enum self_answer tool_self(struct discussion *d)
{
    return d->receiver != d->emitter ? SELF_OTHER
           : d->receiver->vertices   ? SELF_SURFACE
                                     : SELF_CLUSTER;
}

#endif
