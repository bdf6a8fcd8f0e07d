/* shares.c - see shares.h: stretches, pairs, and what is told of values.
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
    }
    if (ranks_any(ranks,
                  !s->stretch || !s->own
                      || (count > 1
                          && (!s->owner || !s->list_first || !s->here.count || !s->there.count)))) {
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

/* ---- ghosts */

static void need(const struct shares *s, unsigned char *needed, uint32_t element)
{
    if (!shares_mine(s, element))
        needed[element] = 1;
}

/* What the links of this rank take light from. Returns how many of it they name: elements of
 * others, and clusters. */
static size_t mark_needed(const struct shares *s, const struct refinement *r, unsigned char *needed)
{
    const struct hierarchy *h = s->hierarchy;
    size_t named = 0;
    for (size_t i = 0; i < r->link_count; i++) {
        const uint32_t e = r->links[i].emitter;
        if (h->elements[e].vertices)
            need(s, needed, e);
        else
            needed[e] = 1;
    }
    for (uint32_t e = 0; e < h->count; e++)
        named += needed[e];
    for (uint32_t e = 0; e < h->built; e++) /* a cluster's faces, once */
        if (needed[e] && !h->elements[e].vertices)
            for (uint32_t i = h->range[e].from; i < h->range[e].to; i++)
                need(s, needed, h->face_element[h->order[i]]);
    return named;
}

/* The elements that are needed, by block and owner. */
static void list_needed(struct shares *s, const unsigned char *needed)
{
    const struct hierarchy *h = s->hierarchy;
    const size_t ranks = (size_t)ranks_count(s->ranks);
    struct ghosts *g = &s->here;
    size_t n = 0;
    memset(g->count, 0, SWEEP_BLOCKS * ranks * sizeof *g->count);
    for (uint32_t i = 0; i < h->count; i++)
        if (needed[i] && h->elements[i].vertices) {
            const uint32_t face = h->elements[i].face;
            g->count[face % SWEEP_BLOCKS * ranks + s->owner[face]]++;
        }
    for (size_t k = 0; k < SWEEP_BLOCKS * ranks; k++) {
        const size_t count = g->count[k];
        if (k % ranks == 0)
            g->first[k / ranks] = n;
        g->count[k] = n;
        n += count;
    }
    g->first[SWEEP_BLOCKS] = n;
    for (uint32_t i = 0; i < h->count; i++)
        if (needed[i] && h->elements[i].vertices) {
            const uint32_t face = h->elements[i].face;
            g->element[g->count[face % SWEEP_BLOCKS * ranks + s->owner[face]]++] = i;
        }
    for (size_t k = SWEEP_BLOCKS * ranks; k-- > 1;) /* ends to numbers */
        g->count[k] -= g->count[k - 1];
}

int shares_find_ghosts(struct shares *s, const struct refinement *r)
{
    const struct hierarchy *h = s->hierarchy;
    const size_t ranks = (size_t)ranks_count(s->ranks);
    if (ranks == 1)
        return 0;
    unsigned char *needed = calloc(h->count, sizeof *needed);
    uint32_t *here = malloc((h->count + 1) * sizeof *here), *asked[SWEEP_BLOCKS] = {0};
    int failed = !needed || !here;
    free(s->here.element);
    s->here.element = here;
    free(s->there.element);
    s->there.element = NULL;
    if (!ranks_any(s->ranks, failed)) {
        s->here.named = mark_needed(s, r, needed);
        list_needed(s, needed);
        size_t n = 0;
        for (uint32_t b = 0; b < SWEEP_BLOCKS && !failed; b++) {
            asked[b] = ranks_exchange(s->ranks, RANKS_LINKS, here + s->here.first[b], sizeof *here,
                                      &s->here.count[b * ranks], &s->there.count[b * ranks]);
            failed = !asked[b];
            s->there.first[b] = n;
            for (size_t k = 0; k < ranks; k++)
                n += s->there.count[b * ranks + k];
        }
        s->there.first[SWEEP_BLOCKS] = n;
        uint32_t *there = failed ? NULL : malloc((n + 1) * sizeof *there);
        failed = ranks_any(s->ranks, !there);
        for (uint32_t b = 0; b < SWEEP_BLOCKS && !failed; b++)
            memcpy(there + s->there.first[b], asked[b],
                   (s->there.first[b + 1] - s->there.first[b]) * sizeof *there);
        s->there.element = there;
    } else {
        failed = 1;
    }
    for (int b = 0; b < SWEEP_BLOCKS; b++)
        free(asked[b]);
    free(needed);
    return failed ? -1 : 0;
}

size_t shares_room(const struct shares *s)
{
    size_t most = 0;
    for (int b = 0; b < SWEEP_BLOCKS && s->owner; b++) {
        const size_t n =
            s->here.first[b + 1] - s->here.first[b] + s->there.first[b + 1] - s->there.first[b];
        most = n > most ? n : most;
    }
    return most;
}

void shares_tell_block(const struct shares *s, uint32_t block, double *values, size_t width,
                       double *room)
{
    const size_t ranks = (size_t)ranks_count(s->ranks);
    if (ranks == 1)
        return;
    const struct ghosts *out = &s->there, *in = &s->here;
    double *to = room;
    for (size_t i = out->first[block]; i < out->first[block + 1]; i++, to += width)
        memcpy(to, &values[out->element[i] * width], width * sizeof *to);
    ranks_exchange_known(s->ranks, RANKS_SWEEPS, room, width * sizeof *room,
                         &out->count[block * ranks], to, &in->count[block * ranks]);
    for (size_t i = in->first[block]; i < in->first[block + 1]; i++, to += width)
        memcpy(&values[in->element[i] * width], to, width * sizeof *to);
}
