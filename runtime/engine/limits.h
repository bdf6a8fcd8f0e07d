/* limits.h - where refinement ends that would not end by itself (limits.c).
 * SPDX-License-Identifier: MIT */
#ifndef LIMITS_H
#define LIMITS_H

#include <stddef.h>
#include <stdint.h>

struct ranks;
struct refinement;
struct refiner;

/* 0 of the first five: the default (limits.c). */
struct limits {
    int depth;                     /* splits below a face */
    uint64_t elements;             /* parts of faces */
    uint64_t links, pairs, rounds; /* of one refinement, over all its passes */
    uint64_t ahead;                /* filled in; 0: `elements` was given */
};

/* The defaults in place of zeros, by the memory that is there now: the same on all ranks, each of
 * which gets its part of what its machine has. NULL: one process. */
struct limits limits_complete(struct limits wanted, struct ranks *ranks);

/* Which limit does refinement meet before it carries out another decision? NULL: none; else its
 * name, and r->limits says what it is. */
const char *limits_met(const struct refinement *r);

/* While several ranks refine: how many of so many pairs may this one discuss now? Pairs are theirs
 * together, so who has had its part of them asks what the others have come to, and waits until
 * these ask, too, or are done. Returns -1 where refinement ends on all. */
int limits_allow(struct refinement *r, int pairs);

/* The limits of several ranks, each of which has refined its part and has failed or not: one that
 * one of them has met all have met, unless one failed for another reason. Returns whether
 * refinement ends here. */
int limits_share(struct refinement *r, struct ranks *ranks, int failed);

/* What was reached, in a sentence or two; `graph` is the oracle interpreted, with the same
 * parameters, and names the node that is at fault (NULL: nobody can). */
void limits_tell(const struct refinement *r, struct refiner *graph, char *text, size_t size);

#endif
