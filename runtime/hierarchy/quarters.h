/* quarters.h - quarters of which each of several ranks makes those of its own faces alone.
 *
 * Particles are counted on quarters of leaves, of which there are many more than anything links
 * know of. Where one rank has them all, a quarter's number is its index in the hierarchy. Where
 * each rank has its own, all still know all numbers, and which are whose parts, 4 bytes each; the
 * elements, hundreds of bytes each, are with the owner of the face, behind those that all have.
 *
 * Invariant: numbers are the indices that one process would give; so what is counted by number does
 * not show how many ranks there are.
 * SPDX-License-Identifier: MIT */
#ifndef QUARTERS_H
#define QUARTERS_H

#include "hierarchy/hierarchy.h"

struct quarters {
    uint32_t common;  /* elements that all ranks have, by the same numbers; 0: all have all */
    uint32_t count;   /* of all ranks together, the common ones once */
    uint32_t leaves;  /* of these, once they are settled (own_quarters.h) */
    uint32_t *child;  /* [count]: by number: that of the first child, or 0; NULL: all are settled */
    uint32_t *number; /* [hierarchy's count - common]: of element common + i here */
    /* [common]: of a leaf that has quarters, how many its owner made before them; NULL before
     * quarters_place */
    uint32_t *place;
    size_t child_capacity, number_capacity;
};

/* All have the hierarchy as it is now. Returns 0, or -1 when out of memory; quarters_close is fine
 * then too. */
int quarters_open(struct quarters *q, const struct hierarchy *h);
void quarters_close(struct quarters *q);

/* Split a leaf that all have until one is worth no more than one part of so many, by area; `mine`:
 * make the elements, too. Returns 0, or -1 when out of memory. */
int quarters_split(struct quarters *q, struct hierarchy *h, uint32_t leaf, double parts, int mine);

/* The number of an element here. */
static inline uint32_t quarters_number(const struct quarters *q, uint32_t element)
{
    return q && q->common && element >= q->common ? q->number[element - q->common] : element;
}

/* Once leaves have been split, in the order of their indices: where the quarters of each are with
 * its owner, owner[face] of so many ranks. Returns 0, or -1 when out of memory. */
int quarters_place(struct quarters *q, const struct hierarchy *h, const uint16_t *owner,
                   size_t ranks);

/* The element that has the number, with the owner of the face; leaf: of those that all have, the
 * one that it is, or is a part of. */
static inline uint32_t quarters_at_owner(const struct quarters *q, uint32_t leaf, uint32_t number)
{
    return number < q->common ? number : q->common + q->place[leaf] + (number - q->child[leaf]);
}

#endif
