/* even_numbers.h - random numbers for suites that make their cases, the same in each run.
 * [xorshift64: Marsaglia 2003]
 * SPDX-License-Identifier: MIT */
#ifndef EVEN_NUMBERS_H
#define EVEN_NUMBERS_H

#include <stdint.h>

/* The next one in [0, 1). */
static inline double even(void)
{
    static uint64_t state = 88172645463325252;
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return (double)(state >> 11) * 0x1p-53;
}

#endif
