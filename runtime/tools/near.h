/* near.h - question: do the two touch, and if not, is their distance below `within` times the
 * larger one's diameter? Touching: nearer than rounding puts a corner to a plane. Where elements
 * are nearer than their size, one-point estimates of F and of its variation fail, and where they
 * touch F has no limit. Of clusters, and beside one, boxes count: so "far" is always true of what
 * they hold. All in m. [Gershbein 1995 for the trouble; D: the measure]
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_NEAR_H
#define TOOL_NEAR_H

#include "discussion.h"
#include "terms/distance.h"
#include "kernel/plane_side.h"

TOOL enum near_answer tool_near(struct discussion *d, double within)
{
    const struct element *r = d->receiver, *s = d->emitter;
    double gap = term_distance(d, DISTANCE_BOUND)[0],
           radius = r->radius > s->radius ? r->radius : s->radius;
    if (gap <= plane_side_flat(r, s, d->host))
        return NEAR_TOUCHING;
    return gap < within * 2 * radius ? NEAR_NEAR : NEAR_FAR;
}

#endif
