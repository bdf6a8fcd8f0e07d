/* places.h - which corners are one place, though rounding sets them apart.
 * SPDX-License-Identifier: MIT */
#ifndef PLACES_H
#define PLACES_H

#include <stddef.h>
#include <stdint.h>

/* What parts two places, of what groups' faces may reach out of their planes; chosen */
enum { PLACES_APART = 8 };

struct corner {
    const double *at; /* [3], m */
    size_t index;     /* of place[] */
};

/* Sets place[index] of each corner to a number from 0 on, the same for corners that no plane across
 * an axis parts, on either side of which `apart` (m) is free. Sorts the corners. */
void places_find(struct corner *corners, size_t count, double apart, uint32_t *place);

#endif
