/* check_thread_pool.c - loops shared by threads: every item once, nobody waited for in vain, nobody
 * spins.
 * SPDX-License-Identifier: MIT */
#include <dirent.h>
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>
#include "suite.h"
#include "util/clock.h"
#include "util/thread_pool.h"

static void nap(int milliseconds)
{
    nanosleep(&(struct timespec){.tv_nsec = milliseconds * 1000000L}, NULL);
}

enum { ITEMS = 1000, THREADS_MOST = 5 };

struct counted {
    size_t count, run;
    int threads;
    atomic_int *times;          /* [item] */
    atomic_int *busy, *strange; /* [thread]; runs that break a promise */
};

static void count_items(const void *context, size_t from, size_t to)
{
    const struct counted *c = context;
    int number = thread_pool_number();
    int odd = number < 0 || number >= c->threads || from % c->run != 0 || from >= to
              || to - from > c->run || to > c->count || (to - from < c->run && to != c->count);
    *c->strange += odd || c->busy[number]++ != 0;
    for (size_t i = from; i < to; i++)
        c->times[i]++;
    c->busy[odd ? 0 : number]--;
}

START_TEST(test_every_item_once)
{
    static const size_t counts[] = {0, 1, 7, 64, ITEMS}, runs[] = {1, 8, 2000};
    for (int threads = 1; threads <= THREADS_MOST; threads++)
        for (size_t i = 0; i < sizeof counts / sizeof *counts; i++)
            for (size_t j = 0; j < sizeof runs / sizeof *runs; j++) {
                atomic_int times[ITEMS + 1] = {0}, busy[THREADS_MOST] = {0}, strange = 0;
                const struct counted c = {counts[i], runs[j], threads, times, busy, &strange};
                thread_pool_run(threads, c.count, c.run, count_items, &c);
                ck_assert_int_eq(strange, 0);
                for (size_t k = 0; k <= ITEMS; k++)
                    ck_assert_int_eq(times[k], k < c.count);
            }
    ck_assert_int_eq(thread_pool_number(), 0);
}
END_TEST

static void meet(const void *context, size_t from, size_t to)
{
    (void)from, (void)to;
    pthread_barrier_wait(*(pthread_barrier_t *const *)context);
}

/* As many threads as were asked for work at a time; else they wait for each other forever. */
START_TEST(test_together)
{
    for (int threads = 2; threads <= THREADS_MOST; threads++) {
        pthread_barrier_t barrier, *context = &barrier;
        pthread_barrier_init(&barrier, NULL, (unsigned)threads);
        thread_pool_run(threads, (size_t)threads, 1, meet, &context);
        pthread_barrier_destroy(&barrier);
    }
}
END_TEST

struct held {
    atomic_int *inside, *release;
};

static void hold(const void *context, size_t from, size_t to)
{
    const struct held *h = context;
    (void)from, (void)to;
    ++*h->inside;
    while (!*h->release)
        nap(1);
}

static void *hold_all(void *context)
{
    thread_pool_run(2, 2, 1, hold, context);
    return NULL;
}

/* The only helper there is is held by another caller's loop: a loop is done all the same. */
START_TEST(test_no_helper_to_be_had)
{
    atomic_int inside = 0, release = 0, times[ITEMS] = {0}, busy[2] = {0}, strange = 0;
    struct held held = {&inside, &release};
    const struct counted c = {ITEMS, 10, 2, times, busy, &strange};
    pthread_t other;
    ck_assert_int_eq(pthread_create(&other, NULL, hold_all, &held), 0);
    while (inside < 2)
        nap(1);
    thread_pool_run(2, ITEMS, 10, count_items, &c);
    for (size_t k = 0; k < ITEMS; k++)
        ck_assert_int_eq(times[k], 1);
    ck_assert_int_eq(strange, 0);
    ck_assert_int_eq(inside, 2);
    release = 1;
    pthread_join(other, NULL);
}
END_TEST

static void count_inside(const void *context, size_t from, size_t to)
{
    int number = thread_pool_number();
    for (size_t i = from; i < to; i++) {
        atomic_int times[ITEMS] = {0}, busy[3] = {0}, strange = 0;
        const struct counted c = {ITEMS, 10, 3, times, busy, &strange};
        thread_pool_run(3, ITEMS, 10, count_items, &c);
        for (size_t k = 0; k < ITEMS; k++)
            strange += times[k] != 1;
        **(atomic_int *const *)context += strange || number != thread_pool_number();
    }
}

START_TEST(test_loops_in_loops)
{
    atomic_int wrong = 0, *context = &wrong;
    thread_pool_run(4, 40, 1, count_inside, &context);
    ck_assert_int_eq(wrong, 0);
}
END_TEST

static void *count_alone(void *context)
{
    atomic_int *wrong = context;
    count_inside(&wrong, 0, 200);
    return NULL;
}

START_TEST(test_callers_side_by_side)
{
    enum { CALLERS = 4 };
    atomic_int wrong = 0;
    pthread_t caller[CALLERS];
    for (int i = 0; i < CALLERS; i++)
        ck_assert_int_eq(pthread_create(&caller[i], NULL, count_alone, &wrong), 0);
    for (int i = 0; i < CALLERS; i++)
        pthread_join(caller[i], NULL);
    ck_assert_int_eq(wrong, 0);
}
END_TEST

static void sleep_if_helper(const void *context, size_t from, size_t to)
{
    (void)from, (void)to;
    pthread_barrier_wait(*(pthread_barrier_t *const *)context);
    if (thread_pool_number() != 0)
        nap(300);
}

/* A caller that waits for a helper takes nothing of the processor, nor do helpers that wait. */
START_TEST(test_nobody_spins)
{
    pthread_barrier_t barrier, *context = &barrier;
    pthread_barrier_init(&barrier, NULL, 2);
    atomic_int wrong = 0, *counted = &wrong;
    thread_pool_run(4, 4, 1, count_inside, &counted);
    ck_assert_int_eq(wrong, 0);
    double before = clock_seconds(CLOCK_PROCESS_CPUTIME_ID), start = seconds();
    thread_pool_run(2, 2, 1, sleep_if_helper, &context);
    ck_assert_double_ge(seconds() - start, 0.3);
    ck_assert_double_le(clock_seconds(CLOCK_PROCESS_CPUTIME_ID) - before, 0.03);
    pthread_barrier_destroy(&barrier);
}
END_TEST

static void note_signals(const void *context, size_t from, size_t to)
{
    sigset_t blocked;
    (void)to;
    pthread_sigmask(SIG_SETMASK, NULL, &blocked);
    if (thread_pool_number() != 0)
        **(atomic_int *const *)context |=
            (sigismember(&blocked, SIGINT) ? 1 : 2) | (sigismember(&blocked, SIGSEGV) ? 4 : 0);
    (void)from;
    nap(1);
}

/* A program's signals go to its own threads. */
START_TEST(test_signals)
{
    atomic_int found = 0, *context = &found;
    while (!found)
        thread_pool_run(2, 8, 1, note_signals, &context);
    ck_assert_int_eq(found, 1);
}
END_TEST

/* Threads of this process, or 0 where the system does not tell. */
static int threads_alive(void)
{
    DIR *tasks = opendir("/proc/self/task");
    int count = 0;
    for (struct dirent *d; tasks && (d = readdir(tasks));)
        count += d->d_name[0] != '.';
    if (tasks)
        closedir(tasks);
    return count;
}

START_TEST(test_the_last_ends_helpers)
{
    thread_pool_retain();
    thread_pool_release();
    int before = threads_alive();
    atomic_int wrong = 0, *context = &wrong;
    for (int again = 0; again < 3; again++) {
        thread_pool_retain();
        thread_pool_retain();
        thread_pool_run(4, 40, 1, count_inside, &context);
        thread_pool_release();
        if (before)
            ck_assert_int_eq(threads_alive(), before + 3);
        thread_pool_release();
        /* the system may still count a thread that has been joined, for a moment */
        for (int wait = 0; wait < 1000 && threads_alive() != before; wait++)
            nap(1);
        ck_assert_int_eq(threads_alive(), before);
    }
    ck_assert_int_eq(wrong, 0);
}
END_TEST

/* The helpers meet first: a thread that starts may hold a lock of a sanitizer's allocator, which
 * the child would inherit held. */
START_TEST(test_fork)
{
    pthread_barrier_t barrier, *all = &barrier;
    atomic_int wrong = 0, *context = &wrong;
    thread_pool_retain();
    pthread_barrier_init(&barrier, NULL, 4);
    thread_pool_run(4, 4, 1, meet, &all);
    pthread_barrier_destroy(&barrier);
    pid_t child = fork();
    if (child == 0) {
        thread_pool_run(4, 40, 1, count_inside, &context);
        thread_pool_release();
        _exit(wrong ? 1 : 0);
    }
    int status = -1;
    ck_assert_int_eq(waitpid(child, &status, 0), child);
    ck_assert_int_eq(status, 0);
    thread_pool_release();
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("thread pool");
    TCase *loops = tcase_create("loops");
    tcase_add_test(loops, test_every_item_once);
    tcase_add_test(loops, test_together);
    tcase_add_test(loops, test_no_helper_to_be_had);
    tcase_add_test(loops, test_loops_in_loops);
    tcase_add_test(loops, test_callers_side_by_side);
    tcase_add_test(loops, test_nobody_spins);
    tcase_add_test(loops, test_signals);
    tcase_add_test(loops, test_the_last_ends_helpers);
    tcase_add_test(loops, test_fork);
    suite_add_tcase(suite, loops);
    return suite_failures(suite) > 0;
}
