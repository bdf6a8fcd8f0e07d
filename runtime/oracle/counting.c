/* counting.c - the walk that counts.
 *
 * It takes the place of the walk in interpreter.c only when counts are wanted, so that they cost
 * nothing otherwise. Every thread that asks has a tally of its own, whoever made the thread; sums
 * are made when asked for. What is counted never reaches a tool, so decisions are the same.
 *
 * Counts are exact. Rays are counted by a host that stands before the discussion's own and hands
 * everything on; terms by the bytes that say their levels, before and after each node. Two readings
 * of the clock cost as much as a cheap node, so one discussion of RAD_TIMED_EVERY is timed, after
 * gaps drawn at random: a fixed step would meet the same half of the pairs, which come in twos and
 * sixteens. A timed discussion during which the thread was off its processor is not told as timed:
 * one such pause lasts longer than the discussions of a second that are timed.
 *
 * A node's pairs in a block of WAVE_PAIRS, as the release in waves is given them, are the list that
 * it would ask there: so the interpreter can tell how full the lists are, of any graph.
 *
 * A path is counted under its number (follow.h); a graph of too many to be numbered has none
 * counted.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "oracle/counting.h"
#include "oracle/follow.h"
#include "oracle/statistics.h"
#include "oracle/tool_table.h"
#include "util/clock.h"
#include "wave.h"

/* The tally that the thread used last, and of which counting: a number that is never given
 * twice. */
static _Thread_local struct {
    uint64_t counting;
    struct tally *tally;
} mine;

static atomic_uint_fast64_t countings;

/* ---- tallies */

static void free_tally(struct tally *t)
{
    if (!t)
        return;
    free(t->levels);
    free(t->paths);
    free(t->spans);
    free(t->called);
    free(t);
}

/* The thread's tally of the program, made when it asks for the first time. NULL: out of memory,
 * which statistics_take tells. */
static struct tally *find_tally(struct program *p)
{
    struct tally *first = atomic_load(&p->tallies), *t = first;
    while (t && t->owner != &mine)
        t = t->next;
    if (!t) {
        /* no line shared */
        t = calloc(1, sizeof *t + p->number_count * sizeof(uint64_t) + 64);
        if (t) {
            t->levels = calloc(((size_t)term_table_count + 7) / 8 + 1, sizeof *t->levels);
            t->path_capacity = 256;
            t->paths = calloc(t->path_capacity, sizeof *t->paths);
            t->spans = calloc((size_t)p->graph->order.count, sizeof *t->spans);
            t->called = calloc((size_t)p->graph->order.count, sizeof *t->called);
        }
        if (!t || !t->levels || !t->paths || !t->spans || !t->called) {
            free_tally(t);
            atomic_store(&p->lost, 1);
            return NULL;
        }
        t->owner = &mine;
        t->wait = 1;
        do
            t->next = first;
        while (!atomic_compare_exchange_weak(&p->tallies, &first, t));
    }
    mine.counting = p->counting;
    mine.tally = t;
    return t;
}

static void forget_counts(struct program *p)
{
    struct tally *t = atomic_exchange(&p->tallies, NULL), *next;
    for (; t; t = next) {
        next = t->next;
        free_tally(t);
    }
    free(p->passes);
    p->passes = NULL;
    p->pass_count = p->pass_capacity = 0;
}

/* ---- what is kept */

static void keep(struct tally *t, enum keeps what, const double *values)
{
    if (what == KEEPS_COUNT) {
        t->counts[values[0] > 0 ? values[0] < RAD_COUNTS ? (int)values[0] : RAD_COUNTS - 1 : 0]++;
    } else {
        int slot = values[1] > 0 ? values[1] < RAD_RECORDS ? (int)values[1] : RAD_RECORDS - 1 : 0;
        if (!(values[0] > 0)) {
            t->zero[slot]++;
            return;
        }
        int e;
        e = isinf(values[0]) ? STATISTICS_HIGH : (frexp(values[0], &e), e - 1);
        e = e < STATISTICS_LOW ? STATISTICS_LOW : e >= STATISTICS_HIGH ? STATISTICS_HIGH - 1 : e;
        t->bins[slot][e - STATISTICS_LOW]++;
    }
}

static void keep_arguments(struct tally *t, const struct step *step, struct discussion *d)
{
    if (step->call != program_compute) {
        keep(t, step->keeps, step->arguments);
        return;
    }
    double values[STACK_MAX];
    program_evaluate(d, (const struct computed *)(const void *)step->arguments, values);
    keep(t, step->keeps, values);
}

/* Where the levels of all terms stand, a byte each; eight at a time are looked at, so that up to
 * seven bytes behind them are, too: those, of the same structure, say nothing. */
static const char *levels_of(const struct discussion *d)
{
    return (const char *)d + offsetof(struct discussion, terms) + term_table[0].level;
}

_Static_assert(sizeof(struct discussion)
                   >= offsetof(struct discussion, terms) + sizeof(struct terms) + sizeof(uint64_t),
               "seven bytes behind the terms are the discussion's");

static void note_levels(struct tally *t, const struct discussion *d)
{
    for (int i = 0; i < term_table_count; i += 8)
        memcpy(&t->levels[i / 8], levels_of(d) + i, sizeof *t->levels);
}

/* Count the terms that are better known than when they were noted, and note them anew. */
static void count_levels(struct tally *t, const struct discussion *d, uint64_t *computed)
{
    for (int i = 0; i < term_table_count; i += 8) {
        uint64_t now;
        memcpy(&now, levels_of(d) + i, sizeof now);
        if (now == t->levels[i / 8])
            continue;
        const unsigned char *was = (const unsigned char *)&t->levels[i / 8],
                            *is = (const unsigned char *)&now;
        for (int k = 0; k < 8 && i + k < term_table_count; k++)
            computed[i + k] += is[k] > was[k];
        t->levels[i / 8] = now;
    }
}

/* ---- paths */

/* Its place among the tally's, or a free one. */
static struct path_count *find_path(struct path_count *paths, size_t capacity, uint64_t number)
{
    size_t at = (size_t)((number * 0x9e3779b97f4a7c15u) >> 20) & (capacity - 1);
    while (paths[at].count && paths[at].number != number)
        at = (at + 1) & (capacity - 1);
    return &paths[at];
}

/* Returns 0, or -1 when out of memory. */
static int grow_paths(struct tally *t)
{
    size_t capacity = 2 * t->path_capacity;
    struct path_count *paths = calloc(capacity, sizeof *paths);
    if (!paths)
        return -1;
    for (size_t i = 0; i < t->path_capacity; i++)
        if (t->paths[i].count)
            *find_path(paths, capacity, t->paths[i].number) = t->paths[i];
    free(t->paths);
    t->paths = paths;
    t->path_capacity = capacity;
    return 0;
}

static void count_path(const struct program *p, struct tally *t, uint64_t number, int timed,
                       uint64_t spent)
{
    struct path_count *path = find_path(t->paths, t->path_capacity, number);
    if (!path->count) {
        if (2 * (t->path_count + 1) > t->path_capacity) {
            if (grow_paths(t) < 0) {
                atomic_store(&p->self->lost, 1);
                return;
            }
            path = find_path(t->paths, t->path_capacity, number);
        }
        t->path_count++;
        path->number = number;
    }
    path->count++;
    path->timed += (uint64_t)timed;
    path->nanoseconds += spent;
}

/* ---- the walk */

/* Gaps of RAD_TIMED_EVERY on average; the same in every run. [Marsaglia 2003] */
static int draw_gap(struct tally *t)
{
    uint32_t x = t->random ? t->random : 2463534242u;
    x ^= x << 13;
    x ^= x >> 17;
    x ^= x << 5;
    t->random = x;
    return 1 + (int)(x % (2 * RAD_TIMED_EVERY - 1));
}

/* Inlined twice, so that what is not timed does not ask whether it is. Times go to t->spans. */
static inline enum decision walk(const struct program *p, struct tally *t, struct discussion *d,
                                 const int timed)
{
    const struct step *step = p->steps;
    uint64_t start = 0, stride = program_stride();
    t->path = 0;
    t->span_count = 0;
    note_levels(t, d);
    for (;;) {
        uint64_t *numbers =
            t->numbers + (size_t)p->answer_count + (size_t)(step - p->steps) * stride;
        uint64_t rays = t->host.rays;
        if (timed)
            start = clock_nanoseconds(CLOCK_MONOTONIC);
        size_t at = (size_t)(step->next - p->next) + (size_t)step->call(d, step->arguments);
        if (timed) {
            uint64_t spent = clock_nanoseconds(CLOCK_MONOTONIC) - start;
            t->spans[t->span_count++] =
                (struct span_of_step){numbers, spent > p->clock ? spent - p->clock : 0};
        }
        t->numbers[at]++;
        numbers[NUMBER_RAYS] += t->host.rays - rays;
        count_levels(t, d, numbers + NUMBER_TERMS);
        if (p->ways)
            t->path += p->ways[at];
        if (step->keeps != KEEPS_NOTHING)
            keep_arguments(t, step, d);
        if (p->next[at] < 0)
            return (enum decision) ~p->next[at];
        step = &p->steps[p->next[at]];
    }
}

/* The same with the clock running. *spent gets all nodes' time (ns). Returns in *timed whether it
 * can be told: the thread's own clock, read before and after, has seen as much as the wall's. */
static enum decision walk_timed(const struct program *p, struct tally *t, struct discussion *d,
                                int *timed, uint64_t *spent)
{
    uint64_t own = clock_nanoseconds(CLOCK_THREAD_CPUTIME_ID),
             wall = clock_nanoseconds(CLOCK_MONOTONIC);
    enum decision decision = walk(p, t, d, 1);
    wall = clock_nanoseconds(CLOCK_MONOTONIC) - wall;
    own = clock_nanoseconds(CLOCK_THREAD_CPUTIME_ID) - own;
    *spent = 0;
    *timed = wall <= own;
    for (size_t i = 0; *timed && i < t->span_count; i++) {
        *spent += t->spans[i].nanoseconds;
        t->spans[i].numbers[NUMBER_TIMED]++;
        t->spans[i].numbers[NUMBER_NANOSECONDS] += t->spans[i].nanoseconds;
    }
    return decision;
}

enum decision program_walk_counted(const void *state, struct discussion *d)
{
    const struct program *p = state;
    struct tally *t = mine.counting == p->counting ? mine.tally : find_tally(p->self);
    if (!t)
        return program_walk(p->steps, d);
    const struct host *host = d->host;
    if (host) {
        counted_host_make(&t->host, host, host);
        d->host = &t->host.host;
    }
    enum decision decision;
    uint64_t spent = 0;
    int timed = 0;
    if (--t->wait > 0) {
        decision = walk(p, t, d, 0);
    } else {
        t->wait = draw_gap(t);
        decision = walk_timed(p, t, d, &timed, &spent);
    }
    if (p->ways)
        count_path(p, t, t->path, timed, spent);
    d->host = host;
    return decision;
}

/* ---- blocks */

/* A vector of 4, of 8 and of 16 pairs: doubles in 256 bits, in 512, floats in 512. */
static const uint64_t widths[RAD_WIDTHS] = {4, 8, 16};

/* How often step i was asked, so far. */
static uint64_t calls_of(const struct program *p, const struct tally *t, int i)
{
    const int *next = p->steps[i].next, *end = i + 1 < p->graph->order.count
                                                   ? p->steps[i + 1].next
                                                   : p->next + p->answer_count;
    uint64_t calls = 0;
    for (; next < end; next++)
        calls += t->numbers[next - p->next];
    return calls;
}

static void count_lists(const struct program *p, struct tally *t)
{
    for (int i = 0; i < p->graph->order.count; i++) {
        const uint64_t pairs = calls_of(p, t, i) - t->called[i];
        uint64_t *numbers = t->numbers + (size_t)p->answer_count + (size_t)i * program_stride();
        numbers[NUMBER_LISTS] += pairs > 0;
        for (int k = 0; k < RAD_WIDTHS; k++)
            numbers[NUMBER_VECTORS + k] += (pairs + widths[k] - 1) / widths[k];
    }
}

/* The walk of many pairs, which also counts how many of WAVE_PAIRS of them came by each node. */
static void walk_block(const void *state, struct discussion *block, int count,
                       enum decision *decisions)
{
    const struct program *p = state;
    for (int from = 0; from < count; from += WAVE_PAIRS) {
        struct tally *t = mine.counting == p->counting ? mine.tally : find_tally(p->self);
        for (int i = 0; t && i < p->graph->order.count; i++)
            t->called[i] = calls_of(p, t, i);
        for (int i = from; i < count && i < from + WAVE_PAIRS; i++)
            decisions[i] = program_walk_counted(p, &block[i]);
        if (t)
            count_lists(p, t);
    }
}

/* ---- to begin with */

/* What two readings of the clock leave between them, ns: the least of many, the others were
 * disturbed. */
static uint64_t clock_cost(void)
{
    uint64_t least = UINT64_MAX;
    for (int i = 0; i < 1000; i++) {
        uint64_t start = clock_nanoseconds(CLOCK_MONOTONIC),
                 between = clock_nanoseconds(CLOCK_MONOTONIC) - start;
        least = between < least ? between : least;
    }
    return least;
}

int refiner_count(struct refiner *r)
{
    struct program *p = r->own;
    if (strcmp(r->release, "dag") != 0)
        return -1;
    forget_counts(p);
    p->forget = forget_counts;
    p->number_count =
        (size_t)p->answer_count + (size_t)p->graph->order.count * (size_t)program_stride();
    if (follow_number(p) < 0)
        return -1;
    p->self = p;
    p->clock = clock_cost();
    p->counting = atomic_fetch_add(&countings, 1) + 1;
    atomic_store(&p->lost, 0);
    r->refine = program_walk_counted;
    r->wave = walk_block;
    r->state = p;
    return 0;
}
