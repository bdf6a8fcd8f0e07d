/* overlap.h - question: do the boxes of the two elements meet? "apart" is true of what they hold.
 * Boxes that meet may hold elements that do not: bounds on distance or cosines say nothing then,
 * and only opening them helps.
 * [Hanrahan et al. 1991 for clusters of volumes; Smits et al. 1994, section 3]
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_OVERLAP_H
#define TOOL_OVERLAP_H

#include "discussion.h"
#include "kernel/element_distance.h"

TOOL enum overlap_answer tool_overlap(struct discussion *d)
{
    double low_r[3], high_r[3], low_s[3], high_s[3];
    distance_box(d->receiver, low_r, high_r);
    distance_box(d->emitter, low_s, high_s);
    if (low_r[0] > high_s[0] || low_r[1] > high_s[1] || low_r[2] > high_s[2])
        return OVERLAP_APART;
    if (low_s[0] > high_r[0] || low_s[1] > high_r[1] || low_s[2] > high_r[2])
        return OVERLAP_APART;
    return OVERLAP_OVERLAPPING;
}

#endif
