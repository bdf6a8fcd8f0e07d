/* thread_pool.c - see thread_pool.h.
 *
 * A loop stands on its caller's stack, in the list of open loops while helpers may join it. A
 * helper joins where runs are left and room is, works until no run is left, and leaves; the caller
 * does the same, takes the loop out of the list, and waits until nobody is inside. All but the next
 * run to be taken is read and written under the pool's lock.
 * SPDX-License-Identifier: MIT */
#define _GNU_SOURCE /* sched_getaffinity */
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <unistd.h>
#include "util/array.h"
#include "util/thread_pool.h"

struct loop {
    struct loop *next; /* in the list of open loops */
    thread_pool_work *work;
    const void *context;
    size_t count, run;
    atomic_size_t taken;      /* items; above count: nothing is left */
    int room, joined, inside; /* helpers */
    pthread_cond_t left;      /* the last one inside has left */
};

struct pool {
    pthread_mutex_t lock;
    pthread_cond_t open; /* there is a loop to join, or nothing to stay for */
    struct loop *loops;
    pthread_t *helpers; /* [count] */
    size_t count, capacity, idle;
    size_t holders, era; /* helpers of an earlier era end */
};

static const struct pool nobody = {.lock = PTHREAD_MUTEX_INITIALIZER,
                                   .open = PTHREAD_COND_INITIALIZER};
static struct pool pool = {.lock = PTHREAD_MUTEX_INITIALIZER, .open = PTHREAD_COND_INITIALIZER};
static _Thread_local int number;

int thread_pool_number(void)
{
    return number;
}

int thread_pool_processors(void)
{
#ifdef __linux__
    cpu_set_t may;
    if (sched_getaffinity(0, sizeof may, &may) == 0)
        return CPU_COUNT(&may);
#endif
    long online = sysconf(_SC_NPROCESSORS_ONLN);
    return online > 0 && online < 1 << 20 ? (int)online : 1;
}

static void work_on(struct loop *l, int as)
{
    int before = number;
    number = as;
    for (;;) {
        size_t from = atomic_fetch_add(&l->taken, l->run);
        if (from >= l->count)
            break;
        l->work(l->context, from, l->count - from > l->run ? from + l->run : l->count);
    }
    number = before;
}

/* A loop that a helper may join, or NULL. */
static struct loop *find_loop(void)
{
    struct loop *l = pool.loops;
    while (l && (l->joined == l->room || atomic_load(&l->taken) >= l->count))
        l = l->next;
    return l;
}

static void *help(void *era)
{
    pthread_mutex_lock(&pool.lock);
    while (pool.era == (size_t)era) {
        struct loop *l = find_loop();
        if (!l) {
            pool.idle++;
            pthread_cond_wait(&pool.open, &pool.lock);
            pool.idle--;
            continue;
        }
        int as = ++l->joined;
        l->inside++;
        pthread_mutex_unlock(&pool.lock);
        work_on(l, as);
        pthread_mutex_lock(&pool.lock);
        if (--l->inside == 0)
            pthread_cond_signal(&l->left);
    }
    pthread_mutex_unlock(&pool.lock);
    return NULL;
}

/* In the child of a fork there are no helpers. */
static void forget_helpers(void)
{
    free(pool.helpers);
    size_t holders = pool.holders;
    pool = nobody;
    pool.holders = holders;
}

static void watch_forks(void)
{
    pthread_atfork(NULL, NULL, forget_helpers);
}

/* One helper more, which leaves all signals but its own faults to the program's threads; or none,
 * where the system has no thread to give: callers go on without. */
static int hire(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    static const int faults[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL};
    sigset_t all, before;
    if (array_reserve(&pool.helpers, pool.count + 1, &pool.capacity, sizeof *pool.helpers) < 0)
        return -1;
    pthread_once(&once, watch_forks);
    sigfillset(&all);
    for (size_t i = 0; i < sizeof faults / sizeof *faults; i++)
        sigdelset(&all, faults[i]);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    int status = pthread_create(&pool.helpers[pool.count], NULL, help, (void *)pool.era);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    pool.count += status == 0;
    return status == 0 ? 0 : -1;
}

static void open_loop(struct loop *l)
{
    pthread_mutex_lock(&pool.lock);
    l->next = pool.loops;
    pool.loops = l;
    while (pool.count < (size_t)l->room && hire() == 0)
        continue;
    for (int i = 0; i < l->room && (size_t)i < pool.idle; i++)
        pthread_cond_signal(&pool.open);
    pthread_mutex_unlock(&pool.lock);
}

static void close_loop(struct loop *l)
{
    pthread_mutex_lock(&pool.lock);
    struct loop **at = &pool.loops;
    while (*at != l)
        at = &(*at)->next;
    *at = l->next;
    while (l->inside)
        pthread_cond_wait(&l->left, &pool.lock);
    pthread_mutex_unlock(&pool.lock);
    pthread_cond_destroy(&l->left);
}

void thread_pool_run(int threads, size_t count, size_t run, thread_pool_work *work,
                     const void *context)
{
    struct loop l = {.work = work, .context = context, .count = count, .run = run};
    size_t runs = count / run + (count % run > 0);
    l.room = (runs < (size_t)threads ? (int)runs : threads) - 1;
    atomic_init(&l.taken, 0);
    if (l.room < 1) {
        work_on(&l, 0);
        return;
    }
    pthread_cond_init(&l.left, NULL);
    open_loop(&l);
    work_on(&l, 0);
    close_loop(&l);
}

void thread_pool_retain(void)
{
    pthread_mutex_lock(&pool.lock);
    pool.holders++;
    pthread_mutex_unlock(&pool.lock);
}

void thread_pool_release(void)
{
    pthread_t *helpers = NULL;
    size_t count = 0;
    pthread_mutex_lock(&pool.lock);
    if (--pool.holders == 0) {
        helpers = pool.helpers;
        count = pool.count;
        pool.helpers = NULL;
        pool.count = pool.capacity = 0;
        pool.era++;
        pthread_cond_broadcast(&pool.open);
    }
    pthread_mutex_unlock(&pool.lock);
    for (size_t i = 0; i < count; i++)
        pthread_join(helpers[i], NULL);
    free(helpers);
}
