/* mend_places.c - see mend_places.h.
 * SPDX-License-Identifier: MIT */
#include "engine/mend_places.h"
#include <stdlib.h>

/* Give places to those of first .. end - 1 that are this rank's. */
static void place_own(struct mend_places *p, const struct light_operator *op, uint32_t first,
                      uint32_t end)
{
    for (uint32_t e = first; e < end; e++)
        if (p->at[e] == MENDED_ELSEWHERE && mend_is_added(op, e))
            p->at[e] = p->held++;
}

/* To clusters of several ranks, and to their children. */
static void place_told(struct mend_places *p, const struct light_operator *op)
{
    const struct hierarchy *h = op->hierarchy;
    for (uint32_t e = 0; e < h->built; e++) {
        const struct element *at = &h->elements[e];
        if (at->vertices || shares_owner(&op->shares, e) != SHARED)
            continue;
        if (p->at[e] == MENDED_ELSEWHERE)
            p->at[e] = p->held++;
        for (uint32_t c = at->child; c < at->child + at->children; c++)
            p->at[c] = p->held++;
    }
}

int mend_places_open(struct mend_places *p, const struct light_operator *op)
{
    const struct hierarchy *h = op->hierarchy;
    *p = (struct mend_places){.common = op->shares.common, .built = h->built, .count = h->count};
    if (!op->shares.common)
        return 0;
    p->at = malloc((size_t)p->common * sizeof *p->at);
    if (!p->at)
        return -1;
    for (uint32_t e = 0; e < p->common; e++)
        p->at[e] = MENDED_ELSEWHERE;
    place_told(p, op);
    p->told = p->held;
    place_own(p, op, 0, h->built);
    p->built = p->held;
    place_own(p, op, h->built, p->common);
    p->count = p->held + (h->count - p->common);
    return 0;
}

void mend_places_close(struct mend_places *p)
{
    free(p->at);
    *p = (struct mend_places){0};
}

void mend_places_levels(const struct light_operator *op, struct levels *levels)
{
    uint32_t kept = 0;
    for (uint32_t level = 0; level < LEVELS; level++) {
        const uint32_t from = levels->from[level];
        levels->from[level] = kept;
        for (uint32_t i = from; i < levels->from[level + 1]; i++)
            if (mend_is_added(op, levels->parent[i]))
                levels->parent[kept++] = levels->parent[i];
    }
    levels->from[LEVELS] = kept;
}
