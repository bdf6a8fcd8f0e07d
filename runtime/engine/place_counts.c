/* place_counts.c - see place_counts.h.
 * SPDX-License-Identifier: MIT */
#include "engine/place_counts.h"
#include <stdlib.h>

/* Add what this rank has counted below an element. */
static void add_below(const struct tally *tally, uint32_t element, int64_t *sum)
{
    const uint32_t child = tally->first[element];
    for (uint32_t k = 0; k < tally->bands && !child; k++)
        sum[k] += tally->element[(size_t)element * tally->bands + k];
    for (uint32_t c = 0; c < 4 && child; c++)
        add_below(tally, child + c, sum);
}

int64_t *place_counts(struct ranks *ranks, const struct tally *tally, const uint32_t *place,
                      uint32_t count)
{
    const size_t bands = tally->bands;
    int64_t *sum = calloc(count * bands + 1, sizeof *sum);
    if (ranks_any(ranks, !sum)) {
        free(sum);
        return NULL;
    }
    for (size_t i = 0; i < count; i++)
        add_below(tally, place[i], &sum[i * bands]);
    ranks_add_counts(ranks, RANKS_PARTICLES, (uint64_t *)sum, count * bands);
    return sum;
}
