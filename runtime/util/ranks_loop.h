/* ranks_loop.h - a loop whose items all ranks share: each does a part of them, by its threads, and
 * then all have what came of all.
 * SPDX-License-Identifier: MIT */
#ifndef RANKS_LOOP_H
#define RANKS_LOOP_H

#include "util/ranks.h"
#include "util/thread_pool.h"

struct ranks_loop {
    thread_pool_work *work;
    const void *context;
    size_t first;
};

static inline void ranks_loop_work(const void *loop, size_t from, size_t to)
{
    const struct ranks_loop *l = loop;
    l->work(l->context, l->first + from, l->first + to);
}

/* As thread_pool_run, which it is where there is one process; item i writes nothing but
 * items[i] of `size` bytes, without pointers that others would read. */
static inline void ranks_loop_run(struct ranks *ranks, enum ranks_kind kind, int threads,
                                  size_t count, size_t run, thread_pool_work *work,
                                  const void *context, void *items, size_t size)
{
    const int me = ranks_number(ranks);
    const size_t from = ranks_part(ranks, count, me), to = ranks_part(ranks, count, me + 1);
    const struct ranks_loop loop = {work, context, from};
    thread_pool_run(threads, to - from, run, ranks_loop_work, &loop);
    ranks_complete_parts(ranks, kind, items, size, count);
}

#endif
