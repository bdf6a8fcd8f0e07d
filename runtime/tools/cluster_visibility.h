/* cluster_visibility.h - question: how many of N rays between the faces of two elements, one of
 * them a cluster at least, arrive? N = 1, 4, 16 or 64, the next above `rays`. Answers as
 * visibility.h gives them; kept as the term `visibility`.
 *
 * Rays go between points of the clusters' faces, not of their boxes: so a cluster shadows itself
 * where its faces do, and what stands within its box does not (kernel/cluster_samples.h). Up to 64
 * rays. Fails: as all sampling; where few of a cluster's faces face the other, few of its points
 * count. [Smits, Arvo, Greenberg 1994, section 5]
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_CLUSTER_VISIBILITY_H
#define TOOL_CLUSTER_VISIBILITY_H

#include "discussion.h"
#include "kernel/cluster_samples.h"
#include "terms/visibility.h"

/* How many segments are made where `count` are cast: of one, more to choose from. */
static inline int cluster_made(int count)
{
    return count == 1 ? VISIBILITY_CHOICE : count;
}

/* The visible fraction by the n segments made, of which `count` are cast at most. */
static inline double cluster_cast(const struct cluster_ends *p, const struct host *host, int count,
                                  int n, struct segment *segments, double *weight)
{
    double seen = 0, whole = 0;
    if (n == 0)
        return 0;
    segments_cast_few(host, n, count, p->hash, segments, weight, &seen, &whole);
    return whole > 0 ? seen / whole : 0;
}

/* The visible fraction by at most `count` segments, up to SEGMENTS_MAX. */
OUTLINE double cluster_rays(const struct element *receiver, const struct element *emitter,
                            const struct host *host, int count)
{
    struct cluster_ends p;
    struct segment segments[SEGMENTS_MAX];
    double weight[SEGMENTS_MAX];
    if (!cluster_ends_open(&p, receiver, emitter, host))
        return 0;
    const int n = cluster_segments(&p, host, cluster_made(count), segments, weight);
    return cluster_cast(&p, host, count, n, segments, weight);
}

/* What the tool says of a visible fraction. */
static inline enum cluster_visibility_answer cluster_visibility_of(double v)
{
    return v <= 0  ? CLUSTER_VISIBILITY_NONE
           : v < 1 ? CLUSTER_VISIBILITY_PARTIAL
                   : CLUSTER_VISIBILITY_ALL;
}

TOOL double term_cluster_visibility(struct discussion *d, enum visibility_level level)
{
    if (level > VISIBILITY_RAYS_64)
        level = VISIBILITY_RAYS_64;
    if (d->terms.visibility_level < level) {
        d->terms.visibility =
            cluster_rays(d->receiver, d->emitter, d->host, visibility_rays_of(level));
        d->terms.visibility_level = (unsigned char)level;
    }
    return d->terms.visibility;
}

TOOL enum cluster_visibility_answer tool_cluster_visibility(struct discussion *d, int rays)
{
    return cluster_visibility_of(term_cluster_visibility(d, visibility_level_of(rays)));
}

#endif
