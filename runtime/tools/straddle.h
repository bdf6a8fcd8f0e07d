/* straddle.h - question: which of the two has parts on both sides of the other's support plane? Of
 * a cluster the box counts, and a cluster has no plane to cross. [Turbet & Sillion, section 3.1.3
 * and figure 2]
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_STRADDLE_H
#define TOOL_STRADDLE_H

#include "discussion.h"
#include "kernel/plane_side.h"

TOOL enum straddle_answer tool_straddle(struct discussion *d)
{
    const struct element *r = d->receiver, *s = d->emitter;
    double flat = plane_side_flat(r, s, d->host);
    if (plane_side_crosses(r, s, flat))
        return plane_side_crosses(s, r, flat) ? STRADDLE_BOTH : STRADDLE_RECEIVER;
    return plane_side_crosses(s, r, flat) ? STRADDLE_EMITTER : STRADDLE_NONE;
}

#endif
