/* coplanar.h - question: do all corners of each surface lie in the other's plane, to rounding? Then
 * F is 0: not a ray is worth casting. Clusters have no plane: no. [SPLASH-3 takes .05 units as
 * flat, whatever the scene's; this scales with the pair]
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_COPLANAR_H
#define TOOL_COPLANAR_H

#include "discussion.h"
#include "kernel/plane_side.h"

TOOL enum coplanar_answer tool_coplanar(struct discussion *d)
{
    const struct element *r = d->receiver, *s = d->emitter;
    double flat = plane_side_flat(r, s, d->host);
    if (!r->vertices || !s->vertices)
        return COPLANAR_NO;
    double low, high;
    plane_side_heights(r, s, &low, &high);
    if (low < -flat || high > flat)
        return COPLANAR_NO;
    plane_side_heights(s, r, &low, &high);
    return low < -flat || high > flat ? COPLANAR_NO : COPLANAR_YES;
}

#endif
