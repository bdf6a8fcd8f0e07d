/* visibility.h - question: how many of N rays between the two elements arrive? N = 1, 4, 16, 64,
 * 256 or 1024, the next above `rays`. A ray that met something beside one that did not is proof of
 * "partial"; "none" and "all" are the rays' opinion. What a shaft has settled (level exact) casts
 * none. One ray is chosen from four segments in proportion to what each would carry
 * (terms/visibility.h): it says 0 or 1, and the mean of that is V. Where the elements are nearer
 * than the larger one's radius rays are chosen so from `near` segments, unless that is 0. [Turbet &
 * Sillion, section 3.1.2]
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_VISIBILITY_H
#define TOOL_VISIBILITY_H

#include "discussion.h"
#include "terms/visibility.h"

TOOL enum visibility_answer tool_visibility(struct discussion *d, int rays, int near)
{
    double v = visibility_known(d, visibility_level_of(rays), near);
    return v <= 0 ? VISIBILITY_NONE : v < 1 ? VISIBILITY_PARTIAL : VISIBILITY_ALL;
}

#endif
