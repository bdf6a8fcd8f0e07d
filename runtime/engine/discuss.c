/* discuss.c - the discussions of a round: what goes into each, what comes out.
 *
 * A refiner that runs in waves is given blocks of WAVE_PAIRS, first all pairs of the block as they
 * stand, then those that are to be discussed the other way round, with what the first found; any
 * other is given one pair at a time, and so is a traced one. Invariant: an outcome depends on its
 * pair alone, so neither blocks nor threads show in the result.
 * SPDX-License-Identifier: MIT */
#include <string.h>
#include "engine/discuss.h"
#include "engine/trace.h"
#include "terms/blockers.h"
#include "util/thread_pool.h"
#include "wave.h"

enum { RUN = 64 }; /* pairs that a thread takes at a time where they go one by one */

/* Discussions that are held together; each pair's list serves both ways round. */
struct block {
    int count;
    int turned;              /* the second way round */
    size_t pair[WAVE_PAIRS]; /* in the round */
    struct discussion d[WAVE_PAIRS];
    enum decision decisions[WAVE_PAIRS];
    struct blockers lists[WAVE_PAIRS]; /* by place in the round, from the block's first pair on */
};

static int block_pairs(const struct refinement *r)
{
    return r->refiner->wave && !r->trace ? WAVE_PAIRS : 1;
}

static size_t run_pairs(const struct refinement *r)
{
    return block_pairs(r) == 1 ? RUN : WAVE_PAIRS;
}

int discuss_divides(unsigned char decision)
{
    return !decision_links((enum decision)decision) && decision != DECISION_STOP;
}

void discuss_reverse(struct link *back, const struct link *there, const struct element *elements)
{
    double areas = elements[there->receiver].area / elements[there->emitter].area;
    back->form_factor = (float)((double)there->form_factor * areas);
    back->visibility = there->visibility;
    back->levels = there->levels;
}

/* The discussion of pair i joins the block; what its link knows goes in. */
static void join(const struct refinement *r, struct block *b, size_t i, struct blockers *list)
{
    const struct element *elements = r->hierarchy->elements;
    const struct link *link = &r->outcomes[i].link[b->turned];
    struct discussion *d = &b->d[b->count];
    b->pair[b->count++] = i;
    d->receiver = &elements[link->receiver];
    d->emitter = &elements[link->emitter];
    d->host = r->host;
    d->blockers = list;
    link_recall(link, &d->terms);
}

static void ask(const struct refinement *r, struct block *b)
{
    if (block_pairs(r) > 1)
        r->refiner->wave(r->refiner->state, b->d, b->count, b->decisions);
    else if (r->trace)
        b->decisions[0] = trace_ask(&r->trace->pairs[b->pair[0]], b->turned, r->refiner, &b->d[0]);
    else
        b->decisions[0] = r->refiner->refine(r->refiner->state, &b->d[0]);
}

/* Hold the block's discussions; the links' values come out, of a pair that is not linked the
 * visibility alone. The block is empty then. */
static void discuss(const struct refinement *r, struct block *b)
{
    if (b->count == 0)
        return;
    ask(r, b);
    for (int k = 0; k < b->count; k++) {
        struct outcome *o = &r->outcomes[b->pair[k]];
        const struct terms *terms = &b->d[k].terms;
        unsigned char *marks = o->marks[b->turned];
        o->decision[b->turned] = (unsigned char)b->decisions[k];
        if (!discuss_divides(o->decision[b->turned]))
            link_store(&o->link[b->turned], b->decisions[k], terms);
        marks[0] = terms->receiver_mark_level ? (unsigned char)terms->receiver_mark : 0;
        marks[1] = terms->emitter_mark_level ? (unsigned char)terms->emitter_mark : 0;
        if (terms->no_number && !o->none)
            o->none = terms->no_number;
    }
    b->count = 0;
}

/* After the discussions of pair i: keep the list for the pairs below, if there will be any. */
static void note_list(const struct refinement *r, size_t i, struct blockers *list, int divided)
{
    const struct element *elements = r->hierarchy->elements;
    const struct link *link = &r->outcomes[i].link[0];
    if (divided && list->wanted)
        blockers_find(&elements[link->receiver], &elements[link->emitter], r->host, list);
    list->wanted = 0;
    r->outcomes[i].listed = list->known == BLOCKERS_OWN && divided;
    if (r->outcomes[i].listed)
        r->found[i] = *list;
}

static struct outcome *begin(const struct refinement *r, size_t i, const struct link *link)
{
    struct outcome *o = &r->outcomes[i];
    o->link[0] = *link;
    o->none = NULL;
    memset(o->marks, 0, sizeof o->marks);
    return o;
}

/* The pairs from .. to - 1, no more than a block: as they stand. */
static void discuss_there(const struct refinement *r, struct block *b, size_t from, size_t to)
{
    b->turned = 0;
    for (size_t i = from; i < to; i++) {
        const struct pair *p = &r->round[i];
        struct blockers *list = &b->lists[i - from];
        list->known = BLOCKERS_UNKNOWN;
        list->wanted = 0;
        if (p->list)
            *list = r->pool[p->list].list;
        (void)begin(r, i, &(struct link){p->receiver, p->emitter, 0, 0, 0, 0});
        join(r, b, i, list);
    }
    discuss(r, b);
}

/* The other way round, with what the first has found. */
static void discuss_back(const struct refinement *r, struct block *b, size_t from, size_t to)
{
    b->turned = 1;
    for (size_t i = from; i < to; i++) {
        const struct pair *p = &r->round[i];
        struct outcome *o = &r->outcomes[i];
        if (!p->both)
            continue;
        if (r->trace)
            r->trace->pairs[i].between = b->lists[i - from];
        o->link[1] = (struct link){p->emitter, p->receiver, 0, 0, 0, 0};
        if (!discuss_divides(o->decision[0]))
            discuss_reverse(&o->link[1], &o->link[0], r->hierarchy->elements);
        join(r, b, i, &b->lists[i - from]);
    }
    discuss(r, b);
}

/* Pairs of the round, from a first one on. */
struct pairs {
    const struct refinement *refinement;
    size_t first;
};

static void discuss_pairs(const void *some, size_t from, size_t to)
{
    const struct refinement *r = ((const struct pairs *)some)->refinement;
    const size_t pairs = (size_t)block_pairs(r), first = ((const struct pairs *)some)->first;
    from += first;
    to += first;
    struct block b;
    b.count = 0;
    for (size_t end; from < to; from = end) {
        end = to - from < pairs ? to : from + pairs;
        discuss_there(r, &b, from, end);
        discuss_back(r, &b, from, end);
        for (size_t i = from; i < end; i++) {
            const unsigned char *decision = r->outcomes[i].decision;
            note_list(r, i, &b.lists[i - from],
                      discuss_divides(decision[0])
                          || (r->round[i].both && discuss_divides(decision[1])));
        }
    }
}

void discuss_round(const struct refinement *r, size_t from, size_t to)
{
    const struct pairs some = {r, from};
    thread_pool_run(r->threads, to - from, run_pairs(r), discuss_pairs, &some);
}

/* Links to be discussed again, as far as an end has changed. */
struct again {
    const struct refinement *refinement;
    const struct link *links;     /* [of the round] */
    const unsigned char *changed; /* [element]; NULL: all have */
};

static void discuss_links(const void *again, size_t from, size_t to)
{
    const struct again *a = again;
    const struct refinement *r = a->refinement;
    const size_t pairs = (size_t)block_pairs(r);
    struct block b;
    b.count = b.turned = 0;
    for (size_t end; from < to; from = end) {
        end = to - from < pairs ? to : from + pairs;
        for (size_t i = from; i < end; i++) {
            const struct link *l = &a->links[i];
            struct outcome *o = begin(r, i, l);
            b.lists[i - from].known = BLOCKERS_UNKNOWN;
            b.lists[i - from].wanted = 0;
            o->decision[0] = (unsigned char)DECISION_LINK;
            o->decision[1] = !a->changed || a->changed[l->receiver] || a->changed[l->emitter];
            if (o->decision[1])
                join(r, &b, i, &b.lists[i - from]);
        }
        discuss(r, &b);
        for (size_t i = from; i < end; i++)
            note_list(r, i, &b.lists[i - from], discuss_divides(r->outcomes[i].decision[0]));
    }
}

void discuss_again(const struct refinement *r, const struct link *links,
                   const unsigned char *changed)
{
    const struct again a = {r, links, changed};
    thread_pool_run(r->threads, (size_t)r->round_count, run_pairs(r), discuss_links, &a);
}
