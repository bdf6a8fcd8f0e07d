/* refine.c - refinement in rounds.
 *
 * A round takes up to ROUND pairs from the end of the queue and gives each to the refiner, both
 * ways round, which only reads the hierarchy; so the pairs of a round run in parallel. Then, in
 * their order, links are appended, elements split, and the children's pairs queued. Invariant:
 * links, their order and the element indices depend on the scene, the oracle and its parameters
 * alone, never on threads, timing or release; nor, once refinement_settle has put them in order, on
 * the order in which pairs were discussed. Taking from the end keeps the queue short: a few rounds'
 * worth, not the square of the faces.
 *
 * Marks that a discussion gives its elements are seen by the rounds to come (mark_elements).
 *
 * Where the oracle looks into the shaft between two elements, the candidates it found are handed on
 * to the pairs below: a list stands once in a pool and counts the pairs that refer to it, which
 * retain and release it. A pair whose discussion made none hands on what it was given; a list that
 * overflowed, or is not good for the pairs below, is released. Lists spare work and change no
 * answer (kernel/shaft.h).
 *
 * Where several ranks refine, each goes on only with the pairs that fall to it (shares_say), and
 * what is said of a pair depends on the pair alone: so they need no messages before the end, but to
 * meet a limit together (limits_allow).
 * [Hanrahan et al. 1991, section 4, for the recursion; Haines & Wallace 1994 for inherited
 * candidates; rounds: derived here]
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "engine/deal.h"
#include "engine/discuss.h"
#include "engine/shares.h"
#include "engine/trace.h"
#include "oracle/statistics.h"
#include "util/array.h"
#include "visibility/rays.h"

enum { ROUND = REFINEMENT_ROUND, LIMITS_EACH = 1024 };

int decision_links(enum decision decision)
{
    return decision == DECISION_LINK || decision == DECISION_LINK_CLUSTERS;
}

void link_store(struct link *link, enum decision decision, const struct terms *terms)
{
    const int of_faces = decision == DECISION_LINK;
    link->form_factor = of_faces ? (float)terms->form_factor : 0;
    link->levels =
        (uint8_t)((of_faces ? terms->form_factor_level : 0) | terms->visibility_level << 4);
    link->mark = of_faces && terms->mark_level ? (uint8_t)terms->mark : 0;
    link->visibility = (uint16_t)(terms->visibility * LINK_VISIBLE + 0.5);
    if (link->visibility == 0 && terms->visibility > 0)
        link->visibility = 1;
    if (link->visibility == LINK_VISIBLE && terms->visibility < 1)
        link->visibility =
            LINK_VISIBLE - 1; /* all and none stay what rays found, not what rounding makes */
}

void link_recall(const struct link *link, struct terms *terms)
{
    memset(terms, 0, sizeof *terms);
    terms->form_factor = (double)link->form_factor;
    terms->form_factor_level = link->levels & 15;
    terms->visibility = link->visibility * (1.0 / LINK_VISIBLE);
    terms->visibility_level = (unsigned char)(link->levels >> 4);
}

int refinement_open(struct refinement *r, struct hierarchy *hierarchy, const struct host *host,
                    const struct refiner *refiner, struct limits limits, int threads)
{
    memset(r, 0, sizeof *r);
    r->hierarchy = hierarchy;
    r->host = host;
    r->refiner = refiner;
    r->threads = threads;
    r->built = hierarchy->count;
    r->limits = limits;
    r->round = malloc(ROUND * sizeof *r->round);
    r->outcomes = malloc(ROUND * sizeof *r->outcomes);
    r->found = malloc(ROUND * sizeof *r->found); /* pages that no oracle fills cost nothing */
    if (!r->round || !r->outcomes || !r->found) {
        refinement_close(r);
        return -1;
    }
    return 0;
}

/* ---- the pool of lists; only between rounds */

static void retain_list(struct refinement *r, uint32_t list, uint32_t references)
{
    if (list)
        r->pool[list].references += references;
}

static void release_list(struct refinement *r, uint32_t list)
{
    if (list && --r->pool[list].references == 0) {
        r->pool[list].next = r->pool_free;
        r->pool_free = list;
    }
}

/* A place for the list, retained once; 0 when there is none: then the pairs below make theirs
 * anew. */
static uint32_t pool_list(struct refinement *r, const struct blockers *list)
{
    uint32_t at = r->pool_free;
    if (at) {
        r->pool_free = r->pool[at].next;
    } else {
        at = r->pool_count ? r->pool_count : 1;
        if (at >= PAIR_LISTS
            || array_reserve(&r->pool, (size_t)at + 1, &r->pool_capacity, sizeof *r->pool) < 0)
            return 0;
        r->pool_count = at + 1;
    }
    r->pool[at].list = *list;
    r->pool[at].list.known = BLOCKERS_INHERITED;
    r->pool[at].references = 1;
    return at;
}

/* The list that the pairs below pair i of the round are given, retained once more; `list`: what
 * it was given itself. */
static uint32_t hand_on(struct refinement *r, int i, uint32_t list)
{
    const struct outcome *o = &r->outcomes[i];
    if (o->listed && r->found[i].handed)
        return pool_list(r, &r->found[i]);
    if (o->listed)
        return 0;
    retain_list(r, list, 1);
    return list;
}

/* An element keeps the first mark that it is given, of those given in one round the least: which
 * pair was discussed first makes no difference. */
static void mark_element(struct refinement *r, uint32_t element, unsigned char mark)
{
    struct element *e = &r->hierarchy->elements[element];
    if (mark && (!e->mark || mark < e->mark))
        e->mark = mark;
}

/* After the discussions of a round, which have seen the marks of those before it; before anything
 * is split, for parts are marked as what they are parts of. */
static void mark_elements(struct refinement *r, int count)
{
    static const unsigned char unmarked[2][2];
    for (int i = 0; i < count; i++) {
        struct outcome *o = &r->outcomes[i];
        if (memcmp(o->marks, unmarked, sizeof unmarked) == 0)
            continue;
        if (r->shares) /* the next round would see them, and other ranks would not */
            o->none = "it marks elements, which all pairs see; run it in one process";
        uint32_t receiver = o->link[0].receiver, emitter = o->link[0].emitter;
        mark_element(r, receiver, o->marks[0][0]);
        mark_element(r, emitter, o->marks[0][1]);
        mark_element(r, emitter, o->marks[1][0]);
        mark_element(r, receiver, o->marks[1][1]);
    }
}

enum { SPLIT_RECEIVER = 1, SPLIT_EMITTER = 2 };

/* Split an element, unless it is. */
static int split_element(struct refinement *r, uint32_t element)
{
    struct hierarchy *h = r->hierarchy;
    if (hierarchy_split(h, element) < 0)
        return -1;
    int depth = h->elements[h->elements[element].child].depth;
    if (depth > r->deepest)
        r->deepest = depth;
    return 0;
}

/* Write the pair behind the queue, unless it is for others. `together`: it comes of one that
 * several ranks have. Returns where the queue ends. */
static struct pair *queue_pair(const struct refinement *r, struct pair *end, struct pair pair,
                               int together)
{
    if (together) {
        const enum shares_say say = shares_say(r->shares, &pair);
        if (say == SHARES_OTHERS)
            return end;
        pair.together = say == SHARES_TOGETHER;
    }
    *end = pair;
    return end + 1;
}

/* Queue the pairs that come of splitting one element of a pair, or both. An element paired with
 * itself gives the pairs of its children with each other and themselves. They retain `list`. */
static int subdivide(struct refinement *r, uint32_t receiver, uint32_t emitter, int split, int both,
                     uint32_t list, int together)
{
    struct hierarchy *h = r->hierarchy;
    uint32_t from_i = receiver, to_i = receiver + 1, from_j = emitter, to_j = emitter + 1;
    if (receiver == emitter)
        split = SPLIT_RECEIVER | SPLIT_EMITTER;
    if ((split & SPLIT_RECEIVER && split_element(r, receiver) < 0)
        || (split & SPLIT_EMITTER && split_element(r, emitter) < 0))
        return -1;
    const struct element *e = &h->elements[receiver];
    const struct element *f = &h->elements[emitter];
    if (split & SPLIT_RECEIVER) {
        from_i = e->child;
        to_i = e->child + e->children;
    }
    if (split & SPLIT_EMITTER) {
        from_j = f->child;
        to_j = f->child + f->children;
    }
    struct pair *q;
    if (array_reserve(&r->queue, r->queue_count + (size_t)(to_i - from_i) * (to_j - from_j),
                      &r->queue_capacity, sizeof *q)
        < 0)
        return -1;
    q = r->queue + r->queue_count;
    for (uint32_t i = from_i; i < to_i; i++) {
        if (receiver != emitter) {
            for (uint32_t j = from_j; j < to_j; j++)
                q = queue_pair(r, q, (struct pair){i, j, (uint32_t)both & 1u, list % PAIR_LISTS, 0},
                               together);
            continue;
        }
        q = queue_pair(r, q, (struct pair){i, i, 0, list % PAIR_LISTS, 0}, together);
        for (uint32_t j = from_j; j < i; j++)
            q = queue_pair(r, q, (struct pair){i, j, 1, list % PAIR_LISTS, 0}, together);
    }
    retain_list(r, list, (uint32_t)((size_t)(q - r->queue) - r->queue_count));
    r->queue_count = (size_t)(q - r->queue);
    return 0;
}

/* Which elements of the pair as it stands a decision splits; `turned`: it was taken the other
 * way round. */
static int splits(enum decision decision, int turned)
{
    switch (decision) {
    case DECISION_SUBDIVIDE_RECEIVER:
        return turned ? SPLIT_EMITTER : SPLIT_RECEIVER;
    case DECISION_SUBDIVIDE_EMITTER:
        return turned ? SPLIT_RECEIVER : SPLIT_EMITTER;
    case DECISION_SUBDIVIDE_BOTH:
        return SPLIT_RECEIVER | SPLIT_EMITTER;
    case DECISION_LINK:
    case DECISION_LINK_CLUSTERS:
    case DECISION_STOP:
        break;
    }
    return 0;
}

/* Is it another rank that counts what this one discusses of the receiver, too? */
static int told_by_others(const struct refinement *r, uint32_t receiver, int together)
{
    return together && !shares_counts(r->shares, receiver);
}

/* Count a decision; of several ranks that have taken it one does. */
static void count(struct refinement *r, uint32_t receiver, enum decision decision, int together)
{
    if (told_by_others(r, receiver, together))
        return;
    r->decided[decision]++;
    r->pairs++;
}

/* Carry out one decision about (receiver, emitter). */
static int carry_out(struct refinement *r, const struct link *link, enum decision decision,
                     uint32_t list, int together)
{
    int split = splits(decision, 0);
    count(r, link->receiver, decision, together);
    if (split)
        return subdivide(r, link->receiver, link->emitter, split, 0, list, together);
    if (decision == DECISION_STOP || (together && !shares_keeps(r->shares, link->receiver)))
        return 0;
    if (array_reserve(&r->links, r->link_count + 1, &r->link_capacity, sizeof *link) < 0)
        return -1;
    r->links[r->link_count++] = *link;
    return 0;
}

/* Carry out both decisions about a pair; when both split the same elements, the children stay
 * paired both ways. */
static int carry_out_both(struct refinement *r, const struct outcome *o, uint32_t list,
                          int together)
{
    enum decision there = (enum decision)o->decision[0], back = (enum decision)o->decision[1];
    int split = splits(there, 0);
    if (!split || split != splits(back, 1))
        return carry_out(r, &o->link[0], there, list, together) < 0
                       || carry_out(r, &o->link[1], back, list, together) < 0
                   ? -1
                   : 0;
    count(r, o->link[0].receiver, there, together);
    count(r, o->link[1].receiver, back, together);
    return subdivide(r, o->link[0].receiver, o->link[0].emitter, split, 1, list, together);
}

/* Tell whoever traces of the round's discussions. Returns 0, or -1: no more. */
static int tell_round(const struct refinement *r, int count)
{
    for (int i = 0; r->trace && i < count; i++) {
        const struct pair *p = &r->round[i];
        const struct outcome *o = &r->outcomes[i];
        struct link there = {p->receiver, p->emitter, 0, 0, 0, 0},
                    back = {p->emitter, p->receiver, 0, 0, 0, 0};
        struct blockers list = {.known = BLOCKERS_UNKNOWN};
        if (p->list)
            list = r->pool[p->list].list;
        if (trace_tell(r->trace, r, (size_t)i, 0, &there, &list) < 0)
            return -1;
        if (!p->both)
            continue;
        if (!discuss_divides(o->decision[0]))
            discuss_reverse(&back, &o->link[0], r->hierarchy->elements);
        if (trace_tell(r->trace, r, (size_t)i, 1, &back, &r->trace->pairs[i].between) < 0)
            return -1;
    }
    return 0;
}

/* The same of links discussed again. */
static int tell_again(const struct refinement *r, const struct link *links, int count)
{
    static const struct blockers unknown = {.known = BLOCKERS_UNKNOWN};
    for (int i = 0; r->trace && i < count; i++)
        if (r->outcomes[i].decision[1]
            && trace_tell(r->trace, r, (size_t)i, 0, &links[i], &unknown) < 0)
            return -1;
    return 0;
}

/* Does refinement go on behind that pair of the round? The limits are looked at every so many
 * pairs. Returns 0, or -1. */
static int go_on(struct refinement *r, int pair)
{
    if (pair % LIMITS_EACH == 0)
        r->met = limits_met(r);
    r->none = r->outcomes[pair].none;
    return r->met || r->none ? -1 : 0;
}

/* Returns 0, or -1 when whoever watches wants no more. */
static int end_round(struct refinement *r)
{
    r->rounds++;
    r->met = limits_met(r);
    return r->met || (r->watch && r->watch(r->watch_context, r)) ? -1 : 0;
}

static uint64_t rays_so_far(const struct refinement *r)
{
    return r->shares ? rays_count(r->rays).rays : 0;
}

/* The pairs that others count, too, come first: their rays are known apart. Returns 0 or -1. */
static int discuss_all(struct refinement *r, int count)
{
    int n = 0;
    if (r->deal)
        return deal_round(r, (size_t)count);
    for (int i = 0; i < count && r->shares; i++)
        if (told_by_others(r, r->round[i].receiver, (int)r->round[i].together)) {
            const struct pair p = r->round[i];
            r->round[i] = r->round[n];
            r->round[n++] = p;
        }
    const uint64_t before = rays_so_far(r);
    discuss_round(r, 0, (size_t)n);
    r->common += rays_so_far(r) - before;
    discuss_round(r, (size_t)n, (size_t)count);
    return 0;
}

/* Rounds until the queue is empty. */
static int drain(struct refinement *r)
{
    while (r->queue_count > 0) {
        int count = limits_allow(r, (int)(r->queue_count < ROUND ? r->queue_count : ROUND));
        if (count < 0)
            return -1;
        r->queue_count -= (size_t)count;
        r->round_count = count;
        memcpy(r->round, r->queue + r->queue_count, (size_t)count * sizeof *r->round);
        if (discuss_all(r, count) < 0 || tell_round(r, count) < 0)
            return -1;
        mark_elements(r, count);
        for (int i = 0; i < count; i++) {
            const struct outcome *o = &r->outcomes[i];
            int both = (int)r->round[i].both, together = (int)r->round[i].together;
            uint32_t list = hand_on(r, i, r->round[i].list);
            if ((both ? carry_out_both(r, o, list, together)
                      : carry_out(r, &o->link[0], (enum decision)o->decision[0], list, together))
                < 0)
                return -1;
            release_list(r, list);
            release_list(r, r->round[i].list);
            if (go_on(r, i) < 0)
                return -1;
        }
        if (end_round(r) < 0)
            return -1;
    }
    return 0;
}

int refinement_start(struct refinement *r)
{
    struct pair root = {0, 0, 0, 0, r->shares != NULL};
    if (array_reserve(&r->queue, 1, &r->queue_capacity, sizeof root) < 0)
        return -1;
    r->queue[r->queue_count++] = root;
    return refinement_resume(r);
}

int refinement_resume(struct refinement *r)
{
    return drain(r) < 0 ? -1 : statistics_end_pass(r->refiner);
}

/* The same of a link that stands. */
static int of_others(const struct refinement *r, const struct link *l)
{
    return r->shares
           && told_by_others(r, l->receiver, shares_owner(r->shares, l->receiver) == SHARED);
}

int64_t refinement_again(struct refinement *r, const unsigned char *changed)
{
    size_t all = r->link_count;
    int64_t moved = 0;
    /* links that stay are written back at or before the place they were read from */
    r->link_count = 0;
    for (size_t from = 0, to; from < all; from = to) {
        const struct link *links = r->links + from;
        to = all - from < ROUND ? all : from + ROUND;
        const int others = of_others(r, links);
        for (size_t i = from; i < to && r->shares; i++)
            if (of_others(r, &r->links[i]) != others)
                to = i;
        int count = (int)(to - from);
        r->round_count = count;
        const uint64_t before = rays_so_far(r);
        discuss_again(r, links, changed);
        r->common += others ? rays_so_far(r) - before : 0;
        if (tell_again(r, links, count) < 0)
            return -1;
        mark_elements(r, count);
        for (int i = 0; i < count; i++) {
            const struct outcome *o = &r->outcomes[i];
            if (!o->decision[1]) {
                r->links[r->link_count++] = o->link[0];
                continue;
            }
            int moves = !decision_links((enum decision)o->decision[0])
                        || memcmp(&o->link[0], &r->links[from + (size_t)i], sizeof o->link[0]) != 0,
                together = r->shares && shares_owner(r->shares, o->link[0].receiver) == SHARED;
            moved += moves && !told_by_others(r, o->link[0].receiver, together);
            uint32_t list = hand_on(r, i, 0);
            if (carry_out(r, &o->link[0], (enum decision)o->decision[0], list, together) < 0)
                return -1;
            release_list(r, list);
            if (go_on(r, i) < 0)
                return -1;
        }
        if (end_round(r) < 0)
            return -1;
    }
    return drain(r) < 0 || statistics_end_pass(r->refiner) < 0 ? -1 : moved;
}

void refinement_close(struct refinement *r)
{
    free(r->links);
    free(r->first_link);
    free(r->queue);
    free(r->round);
    free(r->outcomes);
    free(r->found);
    free(r->pool);
    memset(r, 0, sizeof *r);
}
