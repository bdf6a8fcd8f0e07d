/* watch.h - long work of many threads that is watched, and may be stopped.
 * SPDX-License-Identifier: MIT */
#ifndef WATCH_H
#define WATCH_H

#include <stdint.h>
#include <omp.h>

/* Called now and then with the share that is done, by the thread that called in; nonzero stops. */
struct watch {
    int (*tell)(void *context, double share);
    void *context;
};

/* A parallel loop over `all` parts. */
struct watched_loop {
    const struct watch *watch; /* NULL: nobody asks */
    uint64_t all, done;
    int stopped;
};

/* Before each part: 1: leave it out. */
static inline int watched_loop_stopped(const struct watched_loop *loop)
{
    int stopped;
#pragma omp atomic read
    stopped = loop->stopped;
    return stopped;
}

/* After each part. */
static inline void watched_loop_tell(struct watched_loop *loop)
{
    uint64_t done;
#pragma omp atomic capture
    done = ++loop->done;
    if (loop->watch && omp_get_thread_num() == 0
        && loop->watch->tell(loop->watch->context, (double)done / (double)loop->all)) {
#pragma omp atomic write
        loop->stopped = 1;
    }
}

#endif
