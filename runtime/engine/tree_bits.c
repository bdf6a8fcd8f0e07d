/* tree_bits.c - see tree_bits.h.
 * SPDX-License-Identifier: MIT */
#include "engine/tree_bits.h"
#include "util/array.h"

static void put_bit(struct tree_bits *b, int bit)
{
    const size_t at = b->count / 8;
    if (b->failed || array_reserve(&b->byte, at + 1, &b->capacity, 1) < 0) {
        b->failed = 1;
        return;
    }
    if (b->count % 8 == 0)
        b->byte[at] = 0;
    b->byte[at] = (unsigned char)(b->byte[at] | bit << b->count % 8);
    b->count++;
}

void tree_bits_put_number(struct tree_bits *b, uint32_t number)
{
    for (int i = 0; i < 32; i++)
        put_bit(b, (int)(number >> i & 1));
}

void tree_bits_put(struct tree_bits *b, const struct hierarchy *h, uint32_t element)
{
    const struct element *e = &h->elements[element];
    put_bit(b, e->children != 0);
    for (uint32_t c = 0; c < e->children; c++)
        tree_bits_put(b, h, e->child + c);
}

uint32_t tree_bits_take_number(const unsigned char *byte, size_t *at)
{
    uint32_t number = 0;
    for (int i = 0; i < 32; i++, ++*at)
        number |= (uint32_t)(byte[*at / 8] >> *at % 8 & 1) << i;
    return number;
}

int tree_bits_take(const unsigned char *byte, size_t *at, struct hierarchy *h, uint32_t element)
{
    const int split = byte[*at / 8] >> *at % 8 & 1;
    ++*at;
    if (!split)
        return 0;
    if (hierarchy_split(h, element) < 0)
        return -1;
    for (uint32_t c = 0; c < 4; c++)
        if (tree_bits_take(byte, at, h, h->elements[element].child + c) < 0)
            return -1;
    return 0;
}
