/* refine.h - the refinement loop: a queue of pairs, refined in rounds, leaves links.
 * SPDX-License-Identifier: MIT */
#ifndef REFINE_H
#define REFINE_H

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include "engine/limits.h"
#include "hierarchy/hierarchy.h"
#include "oracle/refiner.h"

/* The receiver gathers form_factor * visibility * B of the emitter. The levels say how well the two
 * are known, so that a link that is discussed again starts from what it knows. 16 bytes. */
struct link {
    uint32_t receiver, emitter; /* elements */
    float form_factor;
    uint16_t visibility; /* in units of 1 / LINK_VISIBLE */
    uint8_t levels; /* of the two: form factor in the low four bits, visibility in the high ones */
    uint8_t mark;   /* what a tool marked it with, 0: nothing (tools/mark.h) */
};

enum { LINK_VISIBLE = 1 << 14, LINK_MARKS = 8 };

/* Of a link that was read, and whose checks say that it is what was written: may one of so many
 * elements be so? */
static inline int link_may_be(const struct link *l, uint64_t elements)
{
    return l->receiver < elements && l->emitter < elements && isfinite(l->form_factor)
           && l->form_factor >= 0 && l->visibility <= LINK_VISIBLE && l->mark < LINK_MARKS;
}

/* The mark by which graphs say that a link was too large and could not be split
 * (runtime/tools/mark.h). */
enum { LINK_GUARDED = 1 };

/* A pair of elements still to be discussed. */
struct pair {
    uint32_t receiver, emitter;
    uint32_t both : 1;  /* 1: discuss it the other way round too */
    uint32_t list : 30; /* in the pool: candidates of a pair that holds this one; 0: none */
    /* 1: other ranks discuss it, too: of its links each keeps its own (shares.h) */
    uint32_t together : 1;
};

enum { PAIR_LISTS = 1 << 30 };

/* What came of a pair, or of a link discussed again: [0] as it stands, [1] the other way round. */
struct outcome {
    struct link link[2];
    unsigned char decision[2];
    /* of each way round: what the discussion marks its receiver [0] and emitter [1] with */
    unsigned char marks[2][2];
    unsigned char listed; /* refinement.found holds the pair's candidates */
    const char *none;     /* which argument of a node was no number; NULL: all were */
};

/* A list of candidates that waiting pairs refer to, or a place for one. */
struct pooled {
    struct blockers list;
    uint32_t references; /* 0: free */
    uint32_t next;       /* free: the next free one, 0: none */
};

struct ranks;
struct refinement;
struct shares;
struct trace;

/* Called after each round, from the calling thread; nonzero stops. */
typedef int refinement_watch(void *context, const struct refinement *refinement);

struct refinement {
    struct hierarchy *hierarchy; /* borrowed; grows */
    const struct host *host;     /* borrowed */
    const struct refiner *refiner;
    int threads;
    refinement_watch *watch; /* may be NULL */
    void *watch_context;
    /* who is told of each discussion, with room for REFINEMENT_ROUND pairs; NULL: nobody. Borrowed
     */
    struct trace *trace;
    /* who else refines, and whom links are for; NULL: this process alone. Borrowed */
    const struct shares *shares;
    const struct rays *rays; /* with it: whose rays are counted, borrowed */
    /* who shares the discussions of each round, while all have all links (deal.h); NULL: nobody.
     * Borrowed, not with `shares` */
    struct ranks *deal;

    struct link *links; /* [link_count]; sorted by receiver after refinement_sort */
    size_t link_count, link_capacity;
    /* [hierarchy->count + 1] after refinement_sort: the links of element e are first_link[e] ..
     * first_link[e + 1] - 1 */
    size_t *first_link;

    struct pair *queue; /* taken from the end */
    size_t queue_count, queue_capacity;
    struct pair *round;       /* the pairs of this round */
    struct outcome *outcomes; /* and what came of them */
    struct blockers *found;   /* and the candidates, where outcome.listed */

    /* [pool_count], [0] unused: lists that pairs hand on to the pairs below them */
    struct pooled *pool;
    uint32_t pool_count, pool_free; /* first free one, 0: none */
    size_t pool_capacity;

    /* Where it ends with an error: the limits, and the one that was met, by name (NULL: none). Of
     * the last round: how many pairs; `outcomes` holds what they decided. */
    struct limits limits;
    const char *met, *none; /* none: what was no number, and ended it; NULL: all was */
    uint64_t allowed; /* of several ranks: pairs before this one asks the others; 0: none has yet */
    int ended;        /* of several ranks: one has met a limit or failed, and all end */
    int round_count;
    uint32_t built; /* elements before the first split */
    int deepest;    /* splits below a face, so far */

    uint64_t pairs, rounds;      /* discussions held, rounds gone */
    uint64_t common;             /* rays of discussions that other ranks count, too, and tell of */
    uint64_t decided[8];         /* how often each decision was taken */
    uint64_t marked[LINK_MARKS]; /* links with each mark, [0] without; counted by refinement_sort */
};

enum { REFINEMENT_ROUND = 1 << 17 }; /* pairs of a round, at the most */

/* Prepare an empty refinement; limits: complete ones. Returns 0, or -1 when out of memory. */
int refinement_open(struct refinement *r, struct hierarchy *hierarchy, const struct host *host,
                    const struct refiner *refiner, struct limits limits, int threads);

/* Refine from the pair (root, root). Returns 0, or -1: out of memory, or `met` a limit. */
int refinement_start(struct refinement *r);

/* Refine on from the pairs that wait. Returns as that. */
int refinement_resume(struct refinement *r);

/* Discuss the links again whose receiver or emitter is marked in changed[elements] (NULL: all of
 * them), with the radiosities as they now are: a link stays, is known better, or gives way to links
 * below it. Returns how many links changed, or -1 as refinement_start does. */
int64_t refinement_again(struct refinement *r, const unsigned char *changed);

/* Give the elements that have been split off since there were `first` the indices that what is
 * split alone decides, not the order in which it was; links follow. Returns 0 or -1. */
int refinement_settle(struct refinement *r, uint32_t first);

/* Sort the links by receiver, those of one by emitter. Returns 0 or -1. */
int refinement_sort(struct refinement *r);

void refinement_close(struct refinement *r);

/* Does the decision make a link? */
int decision_links(enum decision decision);

/* The same link value from the terms of a discussion, and back: of those that the decision reads,
 * as the others may be known to one release and not to another. */
void link_store(struct link *link, enum decision decision, const struct terms *terms);
void link_recall(const struct link *link, struct terms *terms);

#endif
