/* vector_hash.h - a number for three others, the same for those that are equal.
 * SPDX-License-Identifier: MIT */
#ifndef VECTOR_HASH_H
#define VECTOR_HASH_H

#include <stdint.h>
#include <string.h>
#include "kernel/hash.h"

static inline uint64_t vector_hash(const double v[3])
{
    uint64_t hash = 0;
    for (int k = 0; k < 3; k++) {
        const double x = v[k] + 0.0; /* -0 is 0 */
        uint64_t bits;
        memcpy(&bits, &x, sizeof bits);
        hash = hash64(hash + bits + HASH_STEP);
    }
    return hash;
}

static inline int vectors_equal(const double a[3], const double b[3])
{
    for (int k = 0; k < 3; k++)
        if (a[k] < b[k] || a[k] > b[k])
            return 0;
    return 1;
}

#endif
