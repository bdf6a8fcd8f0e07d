/* cluster_visibility.h - question: how many of N rays between the faces of two elements, one of them a cluster at least,
 * arrive? N = 4, 16 or 64, the next above `rays`. Answers as visibility.h gives them.
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_CLUSTER_VISIBILITY_H
#define TOOL_CLUSTER_VISIBILITY_H

#include "discussion.h"
#include "terms/cluster_visibility.h"

TOOL enum cluster_visibility_answer tool_cluster_visibility(struct discussion *d, int rays)
{
    double v = term_cluster_visibility(d, visibility_level_of(rays));
    return v <= 0 ? CLUSTER_VISIBILITY_NONE : v < 1 ? CLUSTER_VISIBILITY_PARTIAL : CLUSTER_VISIBILITY_ALL;
}

#endif
