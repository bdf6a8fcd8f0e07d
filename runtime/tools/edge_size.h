/* edge_size.h - question: has the receiver an edge longer than the larger of `below` (m) and
 * `share` of the scene's extent? For shadows: how finely their outline is to be drawn is a length,
 * whatever light there is. A cluster is as long as its box. [D: derived here]
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_EDGE_SIZE_H
#define TOOL_EDGE_SIZE_H

#include "discussion.h"

TOOL enum edge_size_answer tool_edge_size(struct discussion *d, double below, double share)
{
    const struct element *r = d->receiver;
    double limit = share * d->host->extent, v[3], most = 0;
    int n = r->vertices ? r->vertices : 2;
    if (below > limit)
        limit = below;
    for (int i = 0; i < n; i++) {
        sub3(v, r->vertex[i + 1 < n ? i + 1 : 0], r->vertex[i]);
        most = dot3(v, v) > most ? dot3(v, v) : most;
    }
    return most > limit * limit ? EDGE_SIZE_COARSE : EDGE_SIZE_FINE;
}

#endif
