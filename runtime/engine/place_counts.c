/* place_counts.c - see place_counts.h.
 * SPDX-License-Identifier: MIT */
#include "engine/place_counts.h"
#include <stdlib.h>
#include <string.h>

/* Add what this rank has counted below an element, by its number. */
static void add_below(const struct tally *tally, uint32_t number, int64_t *sum)
{
    const uint32_t child = tally->first[number];
    for (uint32_t k = 0; k < tally->bands && !child; k++)
        sum[k] += tally->element[(size_t)number * tally->bands + k];
    for (uint32_t c = 0; c < 4 && child; c++)
        add_below(tally, child + c, sum);
}

/* Numbers of the places that are asked for, where all ranks ask for the same; else those of all,
 * this rank's from *from on. NULL when out of memory. */
static uint32_t *collect(struct ranks *ranks, const struct tally *tally, const uint32_t *place,
                         uint32_t count, int own, size_t *all, size_t *from)
{
    const size_t n = (size_t)ranks_count(ranks);
    size_t *first = calloc(n + 1, sizeof *first);
    uint32_t *number = NULL;
    *all = count;
    *from = 0;
    if (!ranks_any(ranks, !first)) {
        if (own) {
            ranks_starts(ranks, RANKS_PARTICLES, count, first);
            *all = first[n];
            *from = first[ranks_number(ranks)];
        }
        number = malloc((*all + 1) * sizeof *number);
    }
    if (ranks_any(ranks, !number)) {
        free(number);
        number = NULL;
    }
    for (uint32_t i = 0; i < count && number; i++)
        number[*from + i] = quarters_number(tally->quarters, place[i]);
    if (number && own)
        ranks_complete(ranks, RANKS_PARTICLES, number, sizeof *number, first);
    free(first);
    return number;
}

int64_t *place_counts(struct ranks *ranks, const struct tally *tally, const uint32_t *place,
                      uint32_t count, int own)
{
    const size_t bands = tally->bands;
    size_t all = 0, from = 0;
    uint32_t *number = collect(ranks, tally, place, count, own, &all, &from);
    int64_t *sum = number ? calloc(all * bands + 1, sizeof *sum) : NULL;
    if (ranks_any(ranks, !sum)) {
        free(number);
        free(sum);
        return NULL;
    }
    for (size_t i = 0; i < all; i++)
        add_below(tally, number[i], &sum[i * bands]);
    ranks_add_counts(ranks, RANKS_PARTICLES, (uint64_t *)sum, all * bands);
    memmove(sum, sum + from * bands, count * bands * sizeof *sum);
    free(number);
    return sum;
}
