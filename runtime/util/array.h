/* array.h - arrays that grow by one at a time, in constant time each on average.
 * SPDX-License-Identifier: MIT */
#ifndef ARRAY_H
#define ARRAY_H

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* Make room for one more in an array of `count` items of `size` bytes; `array` points at the
 * pointer to it, which may be NULL. Returns 0, or -1 when out of memory; then nothing has
 * changed. */
static inline int array_reserve(void *array, size_t count, size_t *capacity, size_t size)
{
    if (count < *capacity)
        return 0;
    size_t more = *capacity < 64 ? 64 : *capacity <= SIZE_MAX / 2 ? 2 * *capacity : SIZE_MAX;
    void *old;
    memcpy(&old, array, sizeof old); /* a pointer to any type */
    void *larger = more <= SIZE_MAX / size ? realloc(old, more * size) : NULL;
    if (!larger)
        return -1;
    memcpy(array, &larger, sizeof larger);
    *capacity = more;
    return 0;
}

#endif
