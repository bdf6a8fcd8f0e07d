/* running_sums.h - to choose among things by their weights.
 * SPDX-License-Identifier: MIT */
#ifndef RUNNING_SUMS_H
#define RUNNING_SUMS_H

#include <stdint.h>

/* The first of until[count], which rise, that is above x; the last where none is. Which half holds
 * it nobody can foretell, so no branch asks. */
static inline uint32_t running_sums_find(const double *until, uint32_t count, double x)
{
    uint32_t low = 0;
    for (uint32_t left = count; left > 1;) {
        const uint32_t half = left / 2;
        low += until[low + half - 1] > x ? 0 : half;
        left -= half;
    }
    return low;
}

#endif
