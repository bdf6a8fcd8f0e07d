/* shares.c - see shares.h: stretches, pairs, and values that all are told.
 *
 * Pairs. A pair whose ends have one owner is that rank's, and so is one that is discussed one way,
 * of its receiver's owner. Of two owners both follow it down, and do the same, until its ends are
 * small, at most one of so many UNITS of the faces; there a bit of the two identities says which of
 * the two goes on alone. So work that is common to two ranks is halved in many small pieces, and
 * what is done twice is the square of the units, not of the faces. Pairs with a shared cluster all
 * ranks follow. Nobody has to be asked.
 * SPDX-License-Identifier: MIT */
#include "engine/shares.h"

#include <stdlib.h>
#include <string.h>

enum { UNITS = 64, UNITS_EACH = 8 }; /* at the least, and of each rank */

static uint32_t faces_below(const struct hierarchy *h, uint32_t element)
{
    if (h->elements[element].vertices)
        return 1;
    const struct face_range range = h->range[element];
    return range.to - range.from;
}

enum shares_say shares_say(const struct shares *s, const struct pair *pair)
{
    if (!s->owner)
        return SHARES_ALONE;
    const struct hierarchy *h = s->hierarchy;
    const int me = ranks_number(s->ranks), ranks = ranks_count(s->ranks),
              r = shares_owner(s, pair->receiver), e = shares_owner(s, pair->emitter);
    if (!pair->both && r != SHARED)
        return r == me ? SHARES_ALONE : SHARES_OTHERS;
    if (r == SHARED || e == SHARED)
        return SHARES_TOGETHER;
    if (r == e)
        return r == me ? SHARES_ALONE : SHARES_OTHERS;
    if (r != me && e != me)
        return SHARES_OTHERS;
    const uint32_t units = (uint32_t)(ranks * UNITS_EACH > UNITS ? ranks * UNITS_EACH : UNITS),
                   small = h->face_count / units;
    const uint32_t n = faces_below(h, pair->receiver), m = faces_below(h, pair->emitter);
    if ((n > 1 && n > small) || (m > 1 && m > small))
        return SHARES_TOGETHER;
    const uint64_t bits = h->elements[pair->receiver].id ^ h->elements[pair->emitter].id;
    return (bits >> 32 & 1 ? r : e) == me ? SHARES_ALONE : SHARES_OTHERS;
}

/* This rank's faces by block. */
static void list_own(struct shares *s)
{
    const uint32_t faces = s->hierarchy->face_count;
    const int me = ranks_number(s->ranks);
    uint32_t n = 0;
    for (uint32_t b = 0; b < SWEEP_BLOCKS; b++) {
        s->own_first[b] = n;
        for (uint32_t f = b; f < faces; f += SWEEP_BLOCKS)
            if (!s->owner || s->owner[f] == me)
                s->own[n++] = f;
    }
    s->own_first[SWEEP_BLOCKS] = n;
}

/* Owners as stretches have them; the list of all elements is of other stretches. */
static void own_stretches(struct shares *s)
{
    const struct hierarchy *h = s->hierarchy;
    for (int k = 0; k < ranks_count(s->ranks) && s->owner; k++)
        for (size_t i = s->stretch[k]; i < s->stretch[k + 1]; i++)
            s->owner[h->order[i]] = (uint16_t)k;
    list_own(s);
    s->elements = 0;
}

void shares_divide(struct shares *s, const double *work)
{
    const struct hierarchy *h = s->hierarchy;
    const int ranks = ranks_count(s->ranks);
    double all = 0, until = 0;
    int k = 0;
    for (uint32_t i = 0; i < h->face_count; i++)
        all += work ? work[i] : 1;
    for (uint32_t i = 0; i < h->face_count; i++) {
        while (k < ranks && until >= all * k / ranks)
            s->stretch[k++] = i;
        until += work ? work[h->order[i]] : 1;
    }
    while (k <= ranks)
        s->stretch[k++] = h->face_count;
    own_stretches(s);
}

void shares_restore(struct shares *s, const size_t *stretch)
{
    memcpy(s->stretch, stretch, ((size_t)ranks_count(s->ranks) + 1) * sizeof *stretch);
    own_stretches(s);
}

void shares_take_all(struct shares *s)
{
    const uint32_t faces = s->hierarchy->face_count;
    if (!s->owner)
        return;
    for (int k = 1; k <= ranks_count(s->ranks); k++)
        s->stretch[k] = faces;
    own_stretches(s);
}

int shares_open(struct shares *s, struct ranks *ranks, const struct hierarchy *h)
{
    const size_t count = (size_t)ranks_count(ranks);
    *s = (struct shares){.ranks = ranks, .hierarchy = h};
    s->stretch = calloc(count + 1, sizeof *s->stretch);
    s->own = malloc((h->face_count + 1) * sizeof *s->own);
    if (count > 1) {
        s->owner = malloc(h->face_count * sizeof *s->owner);
        s->list_first = calloc(count + 1, sizeof *s->list_first);
        s->here.count = calloc(SWEEP_BLOCKS * count, sizeof *s->here.count);
        s->there.count = calloc(SWEEP_BLOCKS * count, sizeof *s->there.count);
        s->of_groups.count = calloc(count, sizeof *s->of_groups.count);
        s->to_groups.count = calloc(count, sizeof *s->to_groups.count);
    }
    if (ranks_any(ranks,
                  !s->stretch || !s->own
                      || (count > 1
                          && (!s->owner || !s->list_first || !s->here.count || !s->there.count
                              || !s->of_groups.count || !s->to_groups.count)))) {
        shares_close(s);
        return -1;
    }
    shares_divide(s, NULL);
    return 0;
}

void shares_close(struct shares *s)
{
    free(s->stretch);
    free(s->owner);
    free(s->own);
    free(s->listed);
    free(s->list_first);
    free(s->here.element);
    free(s->here.count);
    free(s->there.element);
    free(s->there.count);
    free(s->of_groups.element);
    free(s->of_groups.count);
    free(s->to_groups.element);
    free(s->to_groups.count);
    *s = (struct shares){0};
}

/* Elements that all ranks have. */
static uint32_t common(const struct shares *s)
{
    return s->common ? s->common : s->hierarchy->count;
}

/* All surfaces of these, rank by rank. */
static int list_elements(struct shares *s)
{
    const struct hierarchy *h = s->hierarchy;
    const int ranks = ranks_count(s->ranks);
    const uint32_t count = common(s);
    uint32_t *listed = realloc(s->listed, (count + 1) * sizeof *listed);
    if (listed)
        s->listed = listed;
    if (ranks_any(s->ranks, !listed))
        return -1;
    memset(s->list_first, 0, ((size_t)ranks + 1) * sizeof *s->list_first);
    for (uint32_t i = 0; i < count; i++)
        if (h->elements[i].vertices)
            s->list_first[s->owner[h->elements[i].face] + 1]++;
    for (int k = 0; k < ranks; k++)
        s->list_first[k + 1] += s->list_first[k];
    for (uint32_t i = 0; i < count; i++)
        if (h->elements[i].vertices)
            s->listed[s->list_first[s->owner[h->elements[i].face]]++] = i;
    memmove(s->list_first + 1, s->list_first, (size_t)ranks * sizeof *s->list_first);
    s->list_first[0] = 0;
    s->elements = count;
    return 0;
}

int shares_complete(struct shares *s, double *values, size_t width)
{
    const int ranks = ranks_count(s->ranks), me = ranks_number(s->ranks);
    if (ranks == 1)
        return 0;
    if (s->elements != common(s) && list_elements(s) < 0)
        return -1;
    const size_t *first = s->list_first;
    double *packed = malloc((first[ranks] * width + 1) * sizeof *packed);
    if (ranks_any(s->ranks, !packed)) {
        free(packed);
        return -1;
    }
    for (size_t i = first[me]; i < first[me + 1]; i++)
        memcpy(&packed[i * width], &values[s->listed[i] * width], width * sizeof *packed);
    ranks_complete(s->ranks, RANKS_VALUES, packed, width * sizeof *packed, first);
    for (size_t i = 0; i < first[ranks]; i++)
        memcpy(&values[s->listed[i] * width], &packed[i * width], width * sizeof *packed);
    free(packed);
    return 0;
}
