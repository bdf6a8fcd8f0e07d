/* ranking.c - see ranking.h.
 *
 * To refine the worst link first is global: it compares a link with all others, which a graph, that
 * sees one pair, cannot do. So the engine asks the tool `worst` for the error times impact of every
 * link, and sets scene.rank to a value that no more than a share of the links exceeds; the graph
 * compares each link with that. Between two passes radiosities, spreads and impacts are solved for
 * anew, and what the last refinement was worth shows. Children of a link that is refined are asked
 * against the same rank and refined on while they are above it, for they are worse than all that
 * waits. A link that a guard kept whole does not count, or the worst would soon be those alone.
 *
 * Every link refined becomes four, so that the budget is met to about that: not more links are let
 * above the rank than a third of what is left of it. Links of the same priority stay together: if
 * the worst are as many as that or more, all of them are refined.
 * [Lischinski, Smits and Greenberg 1994; Holzschuch, Sillion and Drettakis 1994; the threshold by
 * the distribution of errors: Sillion 1995, section 6.2]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "engine/ranking.h"
#include "tools/worst.h"
#include "util/array.h"
#include "util/thread_pool.h"

static double parameter(const struct refiner *r, int role, double otherwise)
{
    int i = refiner_find_role(r, role, -1);
    return i < 0 ? otherwise : refiner_get(r, i);
}

void ranking_start(struct ranking *k, const struct refiner *refiner, struct rays *rays)
{
    k->asked = refiner_reads(refiner, FACT_SCENE_RANK);
    k->share = parameter(refiner, ROLE_WORST_SHARE, 1);
    k->budget = parameter(refiner, ROLE_LINK_BUDGET, INFINITY);
    rays_tell_rank(rays, k->asked ? INFINITY : 0);
}

/* Error times impact of a link, as the tool will find it when the link is discussed (W). */
static double priority_of(const struct light_operator *op, const struct link *l)
{
    struct discussion d;
    double by[2];
    d.receiver = &op->hierarchy->elements[l->receiver];
    d.emitter = &op->hierarchy->elements[l->emitter];
    d.host = rays_host(op->problem->rays);
    d.blockers = NULL;
    if (l->mark == LINK_GUARDED || !d.receiver->vertices || !d.emitter->vertices)
        return 0;
    link_recall(l, &d.terms);
    worst_parts(&d, by);
    return by[0] + by[1];
}

static int falls(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x < y) - (x > y);
}

/* How many links this pass may refine. */
static size_t allowed(const struct ranking *k, size_t links)
{
    double left = (k->budget - (double)links) / 3, share = k->share * (double)links;
    double n = fmin(fmin(left, share), (double)links);
    return left < 1 || !(k->share > 0) ? 0 : n < 1 ? 1 : (size_t)n;
}

/* The rank that `most` of the links exceed, or fewer: those of one priority stay together, unless
 * they are the worst. */
static double rank_of(const double *sorted, size_t links, size_t most)
{
    size_t n = most;
    if (most == 0)
        return INFINITY;
    if (most >= links || !(sorted[most] < sorted[0]))
        while (n < links && !(sorted[n] < sorted[0]))
            n++;
    return n < links ? sorted[n] : 0;
}

struct prioritizing {
    const struct ranking *ranking;
    const struct light_operator *op;
};

static void set_priorities(const void *prioritizing, size_t from, size_t to)
{
    const struct prioritizing *w = prioritizing;
    for (size_t i = from; i < to; i++)
        w->ranking->priority[i] = priority_of(w->op, &w->op->refinement->links[i]);
}

int ranking_update(struct ranking *k, const struct light_operator *op, struct rays *rays,
                   struct oracle_inputs *in)
{
    const struct refinement *r = op->refinement;
    if (array_reserve_beside(&k->sorted, r->link_count, k->capacity, sizeof *k->sorted) < 0
        || array_reserve(&k->priority, r->link_count, &k->capacity, sizeof *k->priority) < 0)
        return -1;
    const struct prioritizing work = {k, op};
    thread_pool_run(op->problem->options.threads, r->link_count, 64, set_priorities, &work);
    if (r->link_count > 0)
        memcpy(k->sorted, k->priority, r->link_count * sizeof *k->sorted);
    qsort(k->sorted, r->link_count, sizeof *k->sorted, falls);
    double rank = rank_of(k->sorted, r->link_count, allowed(k, r->link_count));
    k->above = 0;
    k->all = 0;
    k->worst = r->link_count > 0 ? k->sorted[0] : 0;
    for (size_t i = 0; i < r->link_count; i++) {
        k->all += k->priority[i];
        if (!(k->priority[i] > rank))
            continue;
        in->changed[r->links[i].receiver] = 1;
        k->above++;
    }
    rays_tell_rank(rays, rank);
    return 0;
}

void ranking_free(struct ranking *k)
{
    free(k->priority);
    free(k->sorted);
}
