/* array.h - arrays that grow as they are filled, in constant time per item on average; and numbers
 * in order.
 * SPDX-License-Identifier: MIT */
#ifndef ARRAY_H
#define ARRAY_H

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* Make room for `need` items of `size` bytes, and for half as many again; `array` points at the
 * pointer to them, which may be NULL. Returns 0, or -1 when out of memory; then nothing has
 * changed. */
static inline int array_reserve(void *array, size_t need, size_t *capacity, size_t size)
{
    if (need <= *capacity)
        return 0;
    size_t most = SIZE_MAX / size;
    size_t room = need < most / 2 ? need + need / 2 + 16 : need;
    void *old;
    memcpy(&old, array, sizeof old); /* a pointer to any type */
    void *larger = room <= most ? realloc(old, room * size) : NULL;
    if (!larger)
        return -1;
    memcpy(array, &larger, sizeof larger);
    *capacity = room;
    return 0;
}

/* The same of an array that shares its capacity with others, of which the last is given the
 * capacity's address. */
static inline int array_reserve_beside(void *array, size_t need, size_t capacity, size_t size)
{
    return array_reserve(array, need, &capacity, size);
}

/* For qsort, of doubles, smallest first. */
static inline int compare_numbers(const void *a, const void *b)
{
    const double *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

/* The same of words, or of structs that begin with one. */
static inline int compare_words(const void *a, const void *b)
{
    const uint32_t *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

#endif
