/* place_counts.h - what several ranks have counted on places, while leaves' counts are still apart.
 *
 * There are far fewer places than leaves, and sums of integers have no order: so ranks add what
 * each has counted on a place, and nobody is told of leaves.
 * SPDX-License-Identifier: MIT */
#ifndef PLACE_COUNTS_H
#define PLACE_COUNTS_H

#include "particles/particles.h"

/* Counts of all ranks below the elements place[count]: [place * bands + band], which the caller
 * frees. own: each rank asks for places of its own, else all for the same. NULL on all ranks when
 * any is out of memory. */
int64_t *place_counts(struct ranks *ranks, const struct tally *tally, const uint32_t *place,
                      uint32_t count, int own);

#endif
