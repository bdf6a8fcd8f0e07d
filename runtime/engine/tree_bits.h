/* tree_bits.h - how a face is split, as bits that ranks tell each other: one for each element in
 * preorder, 1 where it is split. Whoever takes them splits alike, at the same places if there is as
 * much before.
 * SPDX-License-Identifier: MIT */
#ifndef TREE_BITS_H
#define TREE_BITS_H

#include <stddef.h>
#include "hierarchy/hierarchy.h"

struct tree_bits {
    unsigned char *byte;    /* owned */
    size_t count, capacity; /* bits; bytes */
    int failed;             /* out of memory: some are missing */
};

void tree_bits_put_number(struct tree_bits *b, uint32_t number);
/* Of the element and all below it. */
void tree_bits_put(struct tree_bits *b, const struct hierarchy *h, uint32_t element);

/* From bit *at on, which then is the one behind. */
uint32_t tree_bits_take_number(const unsigned char *byte, size_t *at);
/* Split as the tree says. Returns 0, or -1 when out of memory. */
int tree_bits_take(const unsigned char *byte, size_t *at, struct hierarchy *h, uint32_t element);

#endif
