/* watch.h - long work of many threads that is watched, and may be stopped.
 * SPDX-License-Identifier: MIT */
#ifndef WATCH_H
#define WATCH_H

#include <stdint.h>
#include <stdatomic.h>
#include "util/thread_pool.h"

/* Called now and then with the share that is done, by the thread that called in; nonzero stops. */
struct watch {
    int (*tell)(void *context, double share);
    void *context;
};

/* A parallel loop over `all` parts. */
struct watched_loop {
    const struct watch *watch; /* NULL: nobody asks */
    uint64_t all;
    _Atomic uint64_t done;
    atomic_int stopped;
};

/* Before each part: 1: leave it out. */
static inline int watched_loop_stopped(const struct watched_loop *loop)
{
    return loop->stopped;
}

/* After each part. */
static inline void watched_loop_tell(struct watched_loop *loop)
{
    uint64_t done = ++loop->done;
    if (loop->watch && thread_pool_number() == 0
        && loop->watch->tell(loop->watch->context, (double)done / (double)loop->all))
        loop->stopped = 1;
}

#endif
