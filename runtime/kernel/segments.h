/* segments.h - visibility by segments, each with the weight of what it would carry.
 * SPDX-License-Identifier: MIT */
#ifndef KERNEL_SEGMENTS_H
#define KERNEL_SEGMENTS_H

#include "discussion.h"

/* Move both ends off the surfaces they are on, whose normals are n and m, as far as rays start. */
static inline void segment_clear(struct segment *g, const double n[3], const double m[3],
                                 const struct host *host)
{
    for (int k = 0; k < 3; k++) {
        g->from[k] += host->ray_offset * n[k];
        g->to[k] += host->ray_offset * m[k];
    }
}

/* Cast up to SEGMENTS_MAX of them: add to *all their weights, to *seen those of what arrives. */
static inline void segments_cast(const struct host *host, int count, const struct segment *segments,
                                 const double *weight, double *seen, double *all)
{
    uint64_t blocked = host->occluded(host, count, segments);
    for (int i = 0; i < count; i++) {
        *all += weight[i];
        if (!(blocked >> i & 1))
            *seen += weight[i];
    }
}

#endif
