/* path_mending.h - are faces told by paths at a lower price than by particles?
 * SPDX-License-Identifier: MIT */
#ifndef PATH_MENDING_H
#define PATH_MENDING_H

#include "engine/mending_goal.h"
#include "particles/path_tally.h"

/* Where a first look by particles (tally) foretells many rays until the error of polygons is what
 * the goal allows, and paths would take far fewer: paths, until theirs is that, or they have cast
 * the most rays. Returns 1: y has been traced, the caller's to close; 0: particles are to go on;
 * -1: out of memory or stopped. */
int path_mending_trace(struct path_tally *y, const struct solve *s, const struct tracer *t,
                       const struct tally *tally, const struct mending_goal *goal,
                       const struct watch *watch);

/* Random numbers of paths: those that mend a solution and those that measure it have none in
 * common. */
static inline uint64_t path_mending_stream(uint64_t stream)
{
    return (uint64_t)0x70617468 << 32 ^ stream << 33;
}

#endif
