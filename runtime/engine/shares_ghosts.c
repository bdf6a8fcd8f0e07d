/* shares_ghosts.c - see shares.h: who is told of what while sweeps go on.
 *
 * Links between surfaces take what their emitter sends as it is. Links with a group at an end take
 * sums over faces, each weighed by where it stands to the link, so that no sum serves two links;
 * but the sums are of single precision, and of means alone. So what only they name, nine in ten in
 * a large room, is told once a sweep, in single precision: the same bits come of it.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "engine/shares.h"

/* Why an element is needed. */
enum { BY_SURFACES = 1, BY_GROUPS = 2 };

static void need(const struct shares *s, unsigned char *needed, uint32_t element, int why)
{
    if (!shares_mine(s, element))
        needed[element] |= (unsigned char)why;
}

/* What the links of this rank take light from. Returns how many of it they name: elements of
 * others, and clusters. */
static size_t mark_needed(const struct shares *s, const struct refinement *r, unsigned char *needed)
{
    const struct hierarchy *h = s->hierarchy;
    size_t named = 0;
    for (size_t i = 0; i < r->link_count; i++) {
        const uint32_t e = r->links[i].emitter;
        if (!h->elements[e].vertices)
            needed[e] = BY_GROUPS;
        else
            need(s, needed, e,
                 h->elements[r->links[i].receiver].vertices ? BY_SURFACES : BY_GROUPS);
    }
    for (uint32_t e = 0; e < h->count; e++)
        named += needed[e] != 0;
    for (uint32_t e = 0; e < h->built; e++) /* a cluster's faces, once */
        if (needed[e] && !h->elements[e].vertices)
            for (uint32_t i = h->range[e].from; i < h->range[e].to; i++)
                need(s, needed, h->face_element[h->order[i]], BY_GROUPS);
    return named;
}

/* Of a face, in which block it is told; what groups alone take is told in one. */
static size_t block_of(uint32_t face, size_t blocks)
{
    return face % blocks;
}

/* Is it told in these blocks? */
static int is_told(unsigned char needed, size_t blocks)
{
    return blocks == 1 ? needed == BY_GROUPS : needed & BY_SURFACES;
}

/* The surfaces that are needed, by block and owner. */
static void list_needed(const struct shares *s, struct ghosts *g, size_t blocks,
                        const unsigned char *needed)
{
    const struct hierarchy *h = s->hierarchy;
    const size_t ranks = (size_t)ranks_count(s->ranks);
    size_t n = 0;
    memset(g->count, 0, blocks * ranks * sizeof *g->count);
    for (uint32_t i = 0; i < h->count; i++)
        if (is_told(needed[i], blocks) && h->elements[i].vertices) {
            const uint32_t face = h->elements[i].face;
            g->count[block_of(face, blocks) * ranks + s->owner[face]]++;
        }
    for (size_t k = 0; k < blocks * ranks; k++) {
        const size_t count = g->count[k];
        if (k % ranks == 0)
            g->first[k / ranks] = n;
        g->count[k] = n;
        n += count;
    }
    g->first[blocks] = n;
    for (uint32_t i = 0; i < h->count; i++)
        if (is_told(needed[i], blocks) && h->elements[i].vertices) {
            const uint32_t face = h->elements[i].face;
            g->element[g->count[block_of(face, blocks) * ranks + s->owner[face]]++] = i;
        }
    for (size_t k = blocks * ranks; k-- > 1;) /* ends to numbers */
        g->count[k] -= g->count[k - 1];
}

/* Ask for them, so that owners know whom to tell. Returns 0 or -1, alike. */
static int ask(const struct shares *s, const struct ghosts *here, struct ghosts *there,
               size_t blocks)
{
    const size_t ranks = (size_t)ranks_count(s->ranks);
    uint32_t *asked[SWEEP_BLOCKS] = {0};
    size_t n = 0;
    int failed = 0;
    for (size_t b = 0; b < blocks && !failed; b++) {
        asked[b] = ranks_exchange(s->ranks, RANKS_LINKS, here->element + here->first[b],
                                  sizeof *here->element, &here->count[b * ranks],
                                  &there->count[b * ranks]);
        failed = !asked[b];
        there->first[b] = n;
        for (size_t k = 0; k < ranks; k++)
            n += there->count[b * ranks + k];
    }
    there->first[blocks] = n;
    there->element = failed ? NULL : malloc((n + 1) * sizeof *there->element);
    failed = ranks_any(s->ranks, !there->element);
    for (size_t b = 0; b < blocks && !failed; b++)
        memcpy(there->element + there->first[b], asked[b],
               (there->first[b + 1] - there->first[b]) * sizeof *there->element);
    for (size_t b = 0; b < blocks; b++)
        free(asked[b]);
    return failed ? -1 : 0;
}

/* The lists of one kind. Returns 0 or -1, alike. */
static int find(const struct shares *s, struct ghosts *here, struct ghosts *there, size_t blocks,
                const unsigned char *needed)
{
    const struct hierarchy *h = s->hierarchy;
    size_t n = 1;
    for (uint32_t i = 0; i < h->count; i++)
        n += is_told(needed[i], blocks) && h->elements[i].vertices;
    free(here->element);
    free(there->element);
    there->element = NULL;
    here->element = malloc(n * sizeof *here->element);
    if (ranks_any(s->ranks, !here->element))
        return -1;
    list_needed(s, here, blocks, needed);
    return ask(s, here, there, blocks);
}

int shares_find_ghosts(struct shares *s, const struct refinement *r)
{
    if (ranks_count(s->ranks) == 1)
        return 0;
    unsigned char *needed = calloc(s->hierarchy->count, sizeof *needed);
    int failed = ranks_any(s->ranks, !needed);
    if (!failed) {
        s->named = mark_needed(s, r, needed);
        failed = find(s, &s->here, &s->there, SWEEP_BLOCKS, needed) < 0
                 || find(s, &s->of_groups, &s->to_groups, 1, needed) < 0;
    }
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
    const size_t by_groups = (s->of_groups.first[1] + s->to_groups.first[1]) / 2 + 1;
    return by_groups > most ? by_groups : most;
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

void shares_tell_groups(const struct shares *s, double *values, size_t width, void *room)
{
    if (ranks_count(s->ranks) == 1)
        return;
    const struct ghosts *out = &s->to_groups, *in = &s->of_groups;
    float *from = room, *to = from;
    for (size_t i = 0; i < out->first[1]; i++)
        for (size_t k = 0; k < width; k++)
            *to++ = (float)values[out->element[i] * width + k];
    ranks_exchange_known(s->ranks, RANKS_SWEEPS, from, width * sizeof *from, out->count, to,
                         in->count);
    for (size_t i = 0; i < in->first[1]; i++)
        for (size_t k = 0; k < width; k++)
            values[in->element[i] * width + k] = (double)*to++;
}
