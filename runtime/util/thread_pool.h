/* thread_pool.h - loops shared by the calling thread and helpers, which sleep when there is nothing
 * to do.
 *
 * The caller works on its loop itself and waits for nobody but helpers that hold a run of it: one
 * that the system has not yet let run is not missed, and nobody spins. So beside other busy
 * processes a loop takes no more of the processors than alone, and no longer than by one thread but
 * for a run at its end. (A barrier of OpenMP waits for all threads of the team; libgomp's spins
 * 300,000 times first, some 10 ms of processor time, unless the environment forbids it before the
 * program starts.) Helpers are the process's, made as loops ask for them: several callers at a time
 * share them, and loops in loops too.
 * SPDX-License-Identifier: MIT */
#ifndef THREAD_POOL_H
#define THREAD_POOL_H

#include <stddef.h>

/* Part of a loop: items from .. to - 1. */
typedef void thread_pool_work(const void *context, size_t from, size_t to);

/* Call `work` for all of 0 .. count - 1, in runs of `run` items (the last may be shorter), by at
 * most `threads` threads. Who gets which run is chance; runs begin at multiples of `run`. */
void thread_pool_run(int threads, size_t count, size_t run, thread_pool_work *work,
                     const void *context);

/* Of the thread, among those of the loop it works on: 0 .. threads - 1; the caller's is 0. Also 0
 * outside of loops. */
int thread_pool_number(void);

/* Processors that this process may use. */
int thread_pool_processors(void);

/* While anybody holds the pool, helpers stay; the last release ends them, so that a library may be
 * unloaded. They come again when a loop asks. */
void thread_pool_retain(void);
void thread_pool_release(void);

#endif
