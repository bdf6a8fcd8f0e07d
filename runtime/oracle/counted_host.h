/* counted_host.h - a host that counts the rays of one discussion, and may show facts of another
 * time.
 *
 * A host's functions know it by its address, so a copy of one would not do: this one passes all
 * calls on. It lives on the stack of whoever asks an oracle, so no two threads share a count.
 * SPDX-License-Identifier: MIT */
#ifndef COUNTED_HOST_H
#define COUNTED_HOST_H

#include "discussion.h"
#include "util/spared_rays.h"

struct counted_host {
    struct host host; /* first, so that a pointer to it is one to all */
    const struct host *real;
    uint64_t rays;
};

static inline uint64_t counted_occluded(const struct host *host, int count,
                                        const struct segment *segments)
{
    struct counted_host *c = (struct counted_host *)(uintptr_t)host;
    uint64_t before = spared_rays, blocked = c->real->occluded(c->real, count, segments);
    c->rays += (uint64_t)count - (spared_rays - before);
    return blocked;
}

static inline int counted_candidates(const struct host *host, const struct shaft *shaft, int most,
                                     uint32_t *faces)
{
    const struct host *real = ((const struct counted_host *)(const void *)host)->real;
    return real->candidates(real, shaft, most, faces);
}

static inline void counted_corners(const struct host *host, uint32_t face, struct polygon *polygon)
{
    const struct host *real = ((const struct counted_host *)(const void *)host)->real;
    real->corners(real, face, polygon);
}

static inline double counted_optical_depth(const struct host *host, const struct segment *segment,
                                           uint32_t receiver, uint32_t emitter)
{
    const struct host *real = ((const struct counted_host *)(const void *)host)->real;
    return real->optical_depth(real, segment, receiver, emitter);
}

/* The numbers of `facts`, which may be a copy made earlier, and the functions of `real`. */
static inline void counted_host_make(struct counted_host *c, const struct host *facts,
                                     const struct host *real)
{
    c->host = *facts;
    c->host.elements = real->elements;
    c->host.occluded = counted_occluded;
    c->host.candidates = real->candidates ? counted_candidates : NULL;
    c->host.exact = real->exact;
    c->host.corners = real->corners ? counted_corners : NULL;
    c->host.optical_depth = real->optical_depth ? counted_optical_depth : NULL;
    c->real = real;
    c->rays = 0;
}

#endif
