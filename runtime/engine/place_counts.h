/* place_counts.h - what several ranks have counted on places, while leaves' counts are still apart.
 *
 * Where all ranks have all leaves there are far fewer places, and sums of integers have no order:
 * so ranks add what each has counted on a place, and nobody is told of leaves.
 * SPDX-License-Identifier: MIT */
#ifndef PLACE_COUNTS_H
#define PLACE_COUNTS_H

#include "particles/particles.h"

/* Counts of all ranks below the elements place[count], the same on all: [place * bands + band],
 * which the caller frees. NULL on all ranks when any is out of memory. */
int64_t *place_counts(struct ranks *ranks, const struct tally *tally, const uint32_t *place,
                      uint32_t count);

#endif
