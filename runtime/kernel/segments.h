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

/* One of them for all: each with a chance in proportion to its weight, by u in [0, 1), so that the
 * mean of what it finds is the share of the weights that arrives. It takes the first place and its
 * weight. [resampled importance sampling, Talbot et al. 2005] */
static inline void segments_choose(int count, struct segment *segments, double *weight, double u)
{
    double sum = 0;
    int chosen = 0;
    for (int i = 0; i < count; i++)
        sum += weight[i];
    u *= sum;
    while (chosen < count - 1 && u >= weight[chosen])
        u -= weight[chosen++];
    segments[0] = segments[chosen];
    weight[0] = sum;
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
