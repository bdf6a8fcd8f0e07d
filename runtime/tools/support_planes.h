/* support_planes.h - question: how do two surfaces lie to each other's support planes?
 *
 * away when one has no part in front of the other: no light can pass. A corner nearer to a
 * plane than rounding puts it lies in the plane, so coplanar and adjoining surfaces get a precise
 * answer.
 * [Turbet & Sillion, section 3.1.3 and figure 2]
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_SUPPORT_PLANES_H
#define TOOL_SUPPORT_PLANES_H

#include "discussion.h"
#include "kernel/plane_side.h"

/* -1: e lies behind the plane of `plane`, 0: crosses it, 1: lies in front. */
static inline int support_planes_side(const struct element *e, const struct element *plane,
                                      double flat)
{
    double low, high;
    const int proved = plane_side_proved(e, plane, flat);
    if (proved)
        return proved;
    plane_side_heights(e, plane, &low, &high);
    return high <= flat ? -1 : low < -flat ? 0 : 1;
}

TOOL enum support_planes_answer tool_support_planes(struct discussion *d)
{
    const struct element *r = d->receiver, *s = d->emitter;
    double flat = plane_side_flat(r, s, d->host);
    int side_r = support_planes_side(r, s, flat);
    if (side_r < 0)
        return SUPPORT_PLANES_AWAY;
    int side_s = support_planes_side(s, r, flat);
    if (side_s < 0)
        return SUPPORT_PLANES_AWAY;
    if (side_r == 0 && (side_s != 0 || r->area > s->area || (r->area == s->area && r->id <= s->id)))
        return SUPPORT_PLANES_RECEIVER_CROSSES;
    return side_s == 0 ? SUPPORT_PLANES_EMITTER_CROSSES : SUPPORT_PLANES_TOWARD;
}

#endif
