/* segments.h - visibility by segments, each with the weight of what it would carry.
 * SPDX-License-Identifier: MIT */
#ifndef KERNEL_SEGMENTS_H
#define KERNEL_SEGMENTS_H

#include "discussion.h"
#include "kernel/hash.h"

/* Move both ends off the surfaces they are on, whose normals are n and m, as far as rays start. */
static inline void segment_clear(struct segment *g, const double n[3], const double m[3],
                                 const struct host *host)
{
    for (int k = 0; k < 3; k++) {
        g->from[k] += host->ray_offset * n[k];
        g->to[k] += host->ray_offset * m[k];
    }
}

/* A few of them for all: each with a chance in proportion to its weight, by u in [0, 1) and equal
 * steps, so that the mean of what they find is the share of the weights that arrives. They take the
 * first places, and equal weights; one that weighs much may be there more than once. [resampled
 * importance sampling, Talbot et al. 2005] */
static inline void segments_choose(int count, int few, struct segment *segments, double *weight,
                                   double u)
{
    struct segment chosen[SEGMENTS_MAX];
    double sum = 0, up_to = weight[0];
    for (int i = 0; i < count; i++)
        sum += weight[i];
    const double step = sum / few;
    for (int i = 0, at = 0; i < few; i++) {
        while (at < count - 1 && (u + i) * step >= up_to)
            up_to += weight[++at];
        chosen[i] = segments[at];
    }
    for (int i = 0; i < few; i++) {
        segments[i] = chosen[i];
        weight[i] = step;
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

/* The same for `few` of them, chosen by a number that the hash gives, where so many were made. */
static inline void segments_cast_few(const struct host *host, int made, int few, uint64_t hash,
                                     struct segment *segments, double *weight, double *seen,
                                     double *all)
{
    if (few < made)
        segments_choose(made, few, segments, weight, hash_unit(hash + HASH_STEP));
    segments_cast(host, few < made ? few : made, segments, weight, seen, all);
}

#endif
