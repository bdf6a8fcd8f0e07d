/* shares.h - who has what of a solve that several ranks share: receivers, and so links and sweeps.
 *
 * Every rank knows all elements, at the same indices. A face, with all its parts, has one owner:
 * the faces in the tree's order are cut into stretches, one a rank, of about the same work. A rank
 * keeps the links whose receiver it has, discusses them, and gathers over them; of the radiosities
 * of others it is told those that its links take light from (ghosts). A cluster whose faces belong
 * to several ranks is shared: links that receive there all ranks keep, each for its own faces below
 * it. A run of one process has everything, by the same code.
 *
 * Invariant: what an element receives is computed by its owner alone, over all its links in the
 * order that refinement_settle gives; so how many ranks there are does not show.
 * SPDX-License-Identifier: MIT */
#ifndef SHARES_H
#define SHARES_H

#include <stddef.h>
#include <stdint.h>
#include "engine/refine.h"
#include "hierarchy/hierarchy.h"
#include "util/ranks.h"

/* Sweeps go through the faces in so many blocks, every so manieth face in one: each rank has its
 * part of every block. */
enum { SWEEP_BLOCKS = 16 };

/* No single rank's. */
enum { SHARED = -1 };

/* Who is told of which elements' values after a block of a sweep, or tells of them. */
struct ghosts {
    uint32_t *element; /* [all]: by block, then by rank */
    /* [SWEEP_BLOCKS * ranks]: how many; [SWEEP_BLOCKS + 1]: where a block's begin in `element` */
    size_t *count, first[SWEEP_BLOCKS + 1];
};

struct shares {
    struct ranks *ranks; /* borrowed; NULL: one process */
    const struct hierarchy *hierarchy;
    /* [ranks + 1]: rank k has the faces order[stretch[k]] .. order[stretch[k + 1] - 1] */
    size_t *stretch;
    uint16_t *owner; /* [face]: its rank; NULL: there is one rank */
    /* the faces of this rank, by block: own[own_first[b]] .. own[own_first[b + 1] - 1] */
    uint32_t *own, own_first[SWEEP_BLOCKS + 1];
    /* [elements]: surfaces, with their parts, rank by rank: listed[list_first[k]] ..; of `elements`
     * elements. Only where there are several ranks, as what follows */
    uint32_t *listed, elements;
    uint32_t common;    /* elements that all have; behind them own ones (own_quarters.h). 0: all */
    size_t *list_first; /* [ranks + 1] */
    struct ghosts here, there;          /* what this rank is told; what it tells */
    struct ghosts of_groups, to_groups; /* the same of what links of groups alone name: one block */
    size_t named; /* what links name: elements of others, and clusters as one each */
};

/* Equal numbers of faces. Returns 0, or -1 when out of memory. */
int shares_open(struct shares *s, struct ranks *ranks, const struct hierarchy *h);
void shares_close(struct shares *s);

/* Stretches of about the same work: work[face], the same on all ranks; NULL: as many faces. */
void shares_divide(struct shares *s, const double *work);
/* Stretches that have been so before: stretch[ranks + 1]. */
void shares_restore(struct shares *s, const size_t *stretch);

/* All is rank 0's: until they are divided again each rank may tell of any links. */
void shares_take_all(struct shares *s);

/* The rank that has an element; SHARED. */
static inline int shares_owner(const struct shares *s, uint32_t element)
{
    if (!s->owner)
        return 0;
    const struct hierarchy *h = s->hierarchy;
    const struct element *e = &h->elements[element];
    if (e->vertices)
        return s->owner[e->face];
    const struct face_range range = h->range[element];
    const int first = s->owner[h->order[range.from]], last = s->owner[h->order[range.to - 1]];
    return first == last ? first : SHARED;
}

static inline int shares_mine(const struct shares *s, uint32_t element)
{
    return !s->owner || shares_owner(s, element) == ranks_number(s->ranks);
}

/* Is the element this rank's to look at where each has elements of its own? Else all look at all.
 */
static inline int shares_looks_at(const struct shares *s, uint32_t element)
{
    return !s->common || shares_mine(s, element);
}

/* This rank's faces, in the tree's order. */
static inline struct face_range shares_here(const struct shares *s)
{
    const int me = ranks_number(s->ranks);
    return (struct face_range){(uint32_t)s->stretch[me], (uint32_t)s->stretch[me + 1]};
}

/* What becomes of a pair that several ranks have come to: it is for others; this rank alone has it
 * and all that is below it; or several go on with it, all the same way. */
enum shares_say { SHARES_OTHERS, SHARES_ALONE, SHARES_TOGETHER };
enum shares_say shares_say(const struct shares *s, const struct pair *pair);

/* Does this rank keep the link? What is received by a shared cluster all keep. */
static inline int shares_keeps(const struct shares *s, uint32_t receiver)
{
    const int owner = shares_owner(s, receiver);
    return owner == SHARED || owner == ranks_number(s->ranks);
}

/* Is a link with this receiver counted by this rank? Each is by one. */
static inline int shares_counts(const struct shares *s, uint32_t receiver)
{
    const int owner = shares_owner(s, receiver);
    return (owner == SHARED ? 0 : owner) == ranks_number(s->ranks);
}

/* After a pass. Its elements, from `first` on, and all links get the order that they alone decide.
 * Where there are several ranks, `r` has what this one has discussed; then all have split what any
 * has, links stand with the owners of their receivers, and stretches are of the same work as far as
 * links tell it. Returns 0, or -1 on all ranks when any is out of memory. */
int shares_settle(struct shares *s, struct refinement *r, uint32_t first);

/* Whom to tell of what while sweeps go on, once links are settled. Returns 0 or -1, alike. */
int shares_find_ghosts(struct shares *s, const struct refinement *r);

/* Tell of the block's values, `width` numbers for each element, those who take light from there. */
void shares_tell_block(const struct shares *s, uint32_t block, double *values, size_t width,
                       double *room);
/* After a sweep, of what links of groups alone take: single precision, which is all they read. */
void shares_tell_groups(const struct shares *s, double *values, size_t width, void *room);
/* What either needs room for: so many doubles for each of a value's numbers. */
size_t shares_room(const struct shares *s);

/* All that this rank is told of. */
static inline size_t shares_ghosts(const struct shares *s)
{
    return s->here.first[SWEEP_BLOCKS] + s->of_groups.first[1];
}
static inline uint32_t shares_ghost(const struct shares *s, size_t i)
{
    const size_t by_surfaces = s->here.first[SWEEP_BLOCKS];
    return i < by_surfaces ? s->here.element[i] : s->of_groups.element[i - by_surfaces];
}

/* Of values[element * width], each rank's own surfaces are right; then all surfaces are, on all
 * ranks. Returns 0 or -1, alike. */
int shares_complete(struct shares *s, double *values, size_t width);

#endif
