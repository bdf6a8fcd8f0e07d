/* hash.h - 64 bits that have nothing to do with each other for numbers that are neighbours: the
 * finaliser of splitmix64.
 * [Steele, Lea, Flood 2014]
 * SPDX-License-Identifier: MIT */
#ifndef KERNEL_HASH_H
#define KERNEL_HASH_H

#include <stdint.h>

/* What splitmix64 adds from one number to the next: 2^64 over the golden ratio, odd. */
#define HASH_STEP 0x9e3779b97f4a7c15u

static inline uint64_t hash64(uint64_t x)
{
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
    x = (x ^ x >> 27) * 0x94d049bb133111ebu;
    return x ^ x >> 31;
}

/* In [0, 1), for the same x. */
static inline double hash_unit(uint64_t x)
{
    return (double)(hash64(x) >> 11) * (1 / 9007199254740992.0);
}

#endif
