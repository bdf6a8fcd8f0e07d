/* running_sums.h - to choose among things by their weights.
 * SPDX-License-Identifier: MIT */
#ifndef RUNNING_SUMS_H
#define RUNNING_SUMS_H

#include <stdint.h>

/* The first of until[count], which rise, that is above x; the last where none is. */
static inline uint32_t running_sums_find(const double *until, uint32_t count, double x)
{
    uint32_t low = 0, high = count - 1;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (until[middle] > x)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

#endif
