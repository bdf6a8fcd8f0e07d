/* exchange_fill.c - see exchange_fill.h.
 *
 * Blocks are filled in their order, some at a time, until the clock says that somebody is to be
 * told. Of several ranks each fills every so manieth block, and at the end, or when a state is
 * wanted, tells the others what came of it.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include "engine/exchange_fill.h"
#include "engine/exchange_state.h"
#include "util/clock.h"
#include "util/thread_pool.h"

/* Somebody is told about so often (s), since he may want no more; at first after a few blocks for
 * each thread, then after twice as many, but for MOST. RUN: that a thread takes at a time. One
 * block takes from a microsecond to a second, so the clock is looked at before each. */
enum { LEAST = 4, MOST = 1 << 20, RUN = 32 };
enum { AT_A_TIME = 1 << 20 }; /* values that ranks tell each other */
static const double OFTEN = 0.5;

/* What blocks are filled from. */
struct filling {
    const struct exchange_areas *areas;
    const struct link **links;        /* [block] */
    struct exchange_scratch *scratch; /* [thread] */
    size_t from;                      /* the first block at hand */
    size_t read;                      /* of the first so many the state has given most */
    size_t told;                      /* of the first so many all ranks have the values */
    unsigned char *done;              /* [block]: it is filled, here */
    uint64_t *rays;                   /* [block]: cast for it */
    double late;                      /* s, when to begin no more of them, */
    atomic_size_t *end;               /* and at which block that was; it is the first not filled */
};

/* The first block from `from` on that the rank fills. Blocks side by side come of one link, or like
 * ones, and cost alike, so each rank gets every so manieth. */
static size_t next_of(const struct exchange_areas *m, size_t from, int rank)
{
    const size_t ranks = (size_t)ranks_count(m->ranks);
    return from + ((size_t)rank + ranks - from % ranks) % ranks;
}

/* Is block i to be left for later? The first at hand never is, so that all come to an end. */
static int is_late(const struct filling *f, size_t i)
{
    size_t end = atomic_load(f->end);
    if (i >= end || i == f->from || seconds() < f->late)
        return i >= end;
    while (i < end && !atomic_compare_exchange_weak(f->end, &end, i))
        ;
    return 1;
}

static void fill_blocks(const void *filling, size_t from, size_t to)
{
    const struct filling *f = filling;
    const struct exchange_areas *m = f->areas;
    const size_t step = (size_t)ranks_count(m->ranks);
    for (size_t i = next_of(m, f->from + from, ranks_number(m->ranks)); i < f->from + to;
         i += step) {
        struct exchange_block *b = &m->blocks[i]; /* no other thread's */
        if (f->done[i])
            continue;
        if (is_late(f, i))
            return;
        const uint64_t before = rays_count_own(m->tree->rays);
        if (!b->anew && (i >= f->read || exchange_link_clear(m->tree, f->links[i])))
            b->error = exchange_tile_fill(m, b, f->links[i], &f->scratch[thread_pool_number()],
                                          m->values + b->at);
        f->rays[i] = rays_count_own(m->tree->rays) - before;
        f->done[i] = 1;
    }
}

/* All ranks have the values of these blocks, which each has filled some of. `room`: for so many
 * values and errors, `first`: for each rank. */
static void tell_some(const struct exchange_areas *m, size_t from, size_t to, double *room,
                      size_t *first)
{
    const int ranks = ranks_count(m->ranks);
    for (int pass = 0; pass < 2; pass++) {
        double *at = room;
        for (int k = 0; k < ranks; k++) {
            first[k] = (size_t)(at - room);
            for (size_t i = next_of(m, from, k); i < to; i += (size_t)ranks) {
                struct exchange_block *b = &m->blocks[i];
                double *values = m->values + b->at;
                const size_t count = exchange_state_values(b);
                if (b->anew)
                    continue;
                if (pass == 0 && k == ranks_number(m->ranks)) {
                    at[0] = b->error;
                    memcpy(at + 1, values, count * sizeof *values);
                } else if (pass == 1) {
                    b->error = at[0];
                    memcpy(values, at + 1, count * sizeof *values);
                }
                at += count + 1;
            }
        }
        first[ranks] = (size_t)(at - room);
        if (pass == 0)
            ranks_complete(m->ranks, RANKS_VALUES, room, sizeof *room, first);
    }
}

/* The same of the first f->from, some at a time. Returns 0, or -1 on all ranks when any is out of
 * memory. */
static int tell_values(struct filling *f)
{
    const struct exchange_areas *m = f->areas;
    const int ranks = ranks_count(m->ranks);
    if (ranks == 1)
        return 0;
    double *room = malloc(AT_A_TIME * sizeof *room);
    size_t *first = malloc(((size_t)ranks + 1) * sizeof *first);
    const int failed = ranks_any(m->ranks, !room || !first);
    for (size_t to = f->told; to < f->from && !failed; f->told = to) {
        for (size_t size = 0; to < f->from; to++) {
            const struct exchange_block *b = &m->blocks[to];
            size += b->anew ? 0 : exchange_state_values(b) + 1;
            if (size > AT_A_TIME)
                break;
        }
        tell_some(m, f->told, to, room, first);
    }
    free(room);
    free(first);
    return failed ? -1 : 0;
}

/* Rays for blocks that are filled, behind one that is not. */
static uint64_t rays_behind(const struct filling *f)
{
    uint64_t sum = 0;
    for (size_t i = f->from; i < f->areas->block_count; i++)
        sum += f->rays[i];
    return sum;
}

/* Somebody is told that the first f->from blocks are there. Returns nonzero: he wants no more. */
static int tell(struct filling *f, const struct exchange_aim *how)
{
    const struct exchange_areas *m = f->areas;
    const size_t at = f->from < m->block_count ? m->blocks[f->from].at : m->kept;
    if (how->tell && how->tell(how->context, (double)at / (double)(m->kept ? m->kept : 1)))
        return 1;
    return how->state && f->from > f->read && exchange_state_ask(how->state)
           && (tell_values(f) < 0
               || exchange_state_put(how->state, m, f->links, f->from, rays_behind(f)));
}

/* Fill the next blocks, as far as that goes until `late`; blocks behind one that was left may be,
 * too. Of several ranks each fills its own; the first that any has left is where they go on. */
static void fill_some(struct filling *f, size_t count, double late, int threads)
{
    const size_t run = count / 8 < RUN ? count / 8 : RUN;
    atomic_size_t end;
    atomic_init(&end, f->from + count);
    f->late = late;
    f->end = &end;
    thread_pool_run(threads, count, run ? run : 1, fill_blocks, f);
    f->from = ranks_least(f->areas->ranks, RANKS_VALUES, atomic_load(&end));
}

int exchange_fill(struct exchange_areas *m, const struct link **links,
                  const struct exchange_aim *how)
{
    const int threads = how->threads;
    struct exchange_scratch *scratch = calloc((size_t)threads, sizeof *scratch);
    const int64_t read = how->state ? exchange_state_read_values(how->state, m, links) : 0;
    struct filling f = {
        .areas = m, .links = links, .scratch = scratch, .read = read > 0 ? (size_t)read : 0};
    size_t next = LEAST * (size_t)threads;
    f.done = calloc(m->block_count + 1, 1);
    f.rays = calloc(m->block_count + 1, sizeof *f.rays);
    int failed = !scratch || !f.done || !f.rays || read < 0;
    for (int t = 0; t < threads && !failed; t++)
        failed = exchange_scratch_open(&scratch[t], &m->limits) < 0;
    failed = ranks_any(m->ranks, failed);
    if (f.read && !failed) { /* those of groups in clear view */
        fill_some(&f, f.read, INFINITY, threads);
        failed = tell(&f, how);
    }
    while (f.from < m->block_count && !failed) {
        const size_t left = m->block_count - f.from;
        fill_some(&f, left < next ? left : next, seconds() + OFTEN, threads);
        next = next < MOST ? 2 * next : next;
        failed = tell(&f, how);
    }
    failed = failed || tell_values(&f) < 0;
    for (size_t i = next_of(m, 0, ranks_number(m->ranks)); i < m->block_count && !failed;
         i += (size_t)ranks_count(m->ranks))
        m->own_count += m->blocks[i].anew ? 0 : exchange_state_values(&m->blocks[i]);
    for (int t = 0; t < threads && scratch; t++)
        exchange_scratch_close(&scratch[t]);
    free(scratch);
    free(f.done);
    free(f.rays);
    return failed ? -1 : 0;
}
