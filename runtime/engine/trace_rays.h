/* trace_rays.h - particles of a solution, traced until so many rays are cast, while who waits is
 * told how far that is.
 * SPDX-License-Identifier: MIT */
#ifndef TRACE_RAYS_H
#define TRACE_RAYS_H

#include "engine/solve.h"
#include "particles/particles.h"

/* Rays cast before, now, and in the end, about. A watch whose context it is tells by
 * watched_rays_tell. */
struct watched_rays {
    struct solve *solve;
    uint64_t before;
    double now, all;
};

int watched_rays_tell(void *watched_rays, double share);

/* Trace until about so many rays are cast, of `all` that may follow. Where there are several ranks
 * counts are still to be added, as far as somebody asks for them. Returns 0, or -1 when
 * cancelled. */
int trace_rays(struct solve *s, const struct tracer *t, struct tally *tally, uint64_t rays,
               double all);

/* Sets *cause, of what has failed as all here does: cancelled, or out of memory. Returns -1. */
int trace_rays_failed(const struct solve *s, const char **cause);

#endif
