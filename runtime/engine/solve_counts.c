/* solve_counts.c - what refinement has come to on all ranks: links, pairs, rays, decisions.
 * SPDX-License-Identifier: MIT */
#include <string.h>
#include "engine/solve.h"
#include "kernel/hash.h"
#include "util/thread_pool.h"

/* Links, added up by threads. */
struct link_counts {
    _Atomic uint64_t links, marked[LINK_MARKS], fingerprint;
};

struct link_counting {
    const struct solve *s;
    struct link_counts *all;
};

static void count_links(const void *counting, size_t from, size_t to)
{
    const struct link_counting *x = counting;
    const struct solve *s = x->s;
    struct pass_counts c = {0};
    for (size_t i = from; i < to; i++) {
        const struct link *l = &s->refinement.links[i];
        if (!shares_counts(&s->operator.shares, l->receiver))
            continue;
        uint64_t bits = 0;
        memcpy(&bits, &l->form_factor, sizeof l->form_factor);
        bits |= (uint64_t)l->visibility << 32 | (uint64_t)l->levels << 48 | (uint64_t)l->mark << 56;
        c.links++;
        c.marked[l->mark]++;
        c.fingerprint += hash64(s->hierarchy.elements[l->receiver].id
                                + hash64(s->hierarchy.elements[l->emitter].id + hash64(bits)));
    }
    x->all->links += c.links;
    x->all->fingerprint += c.fingerprint;
    for (int i = 0; i < LINK_MARKS; i++)
        x->all->marked[i] += c.marked[i];
}

void solve_count_links(struct solve *s)
{
    const struct refinement *r = &s->refinement;
    struct ranks *ranks = s->problem.options.ranks;
    struct pass_counts *c = &s->report.counts;
    double rounds = (double)r->rounds;
    *c = (struct pass_counts){.pairs = r->pairs,
                              .rays = rays_count(s->problem.rays).rays - r->common};
    memcpy(c->decided, r->decided, sizeof c->decided);
    struct link_counts all = {0};
    const struct link_counting counting = {s, &all};
    thread_pool_run(s->problem.options.threads, r->link_count, 4096, count_links, &counting);
    c->links = all.links;
    c->fingerprint = all.fingerprint;
    for (int i = 0; i < LINK_MARKS; i++)
        c->marked[i] = all.marked[i];
    ranks_add_counts(ranks, RANKS_VALUES, (uint64_t *)c, sizeof *c / sizeof(uint64_t));
    ranks_most(ranks, RANKS_VALUES, &rounds, 1);
    s->report.rounds = (uint64_t)rounds;
}
