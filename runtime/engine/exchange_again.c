/* exchange_again.c - see exchange_again.h.
 *
 * The pairs are listed first; what they come to stands in the list until all are done.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include "engine/exchange_again.h"
#include "engine/exchange_state.h"
#include "engine/exchange_tiles.h"
#include "util/ranks_loop.h"

/* So many pairs, on all ranks alike, however many threads these have, then somebody is told; each
 * takes from microseconds to a second. */
enum { AT_A_TIME = 256 };

/* An entry: its two faces, or parts of faces; which value of which block. */
struct entry {
    uint32_t receiver, emitter;
    size_t block, at;
    double value, error; /* m2 */
};

struct looking {
    const struct exchange_areas *areas;
    struct exchange_scratch *scratch; /* [thread] */
    struct entry *entries;
};

/* The face at that place, or the part of one that the link is of. */
static uint32_t element_at(const struct exchange_tree *t, uint32_t linked, uint32_t place)
{
    return t->h.elements[linked].group ? t->h.face_element[t->h.order[place]] : linked;
}

/* All entries of rows that are off, of blocks of these links: listed, or counted only. */
static size_t list_entries(const struct exchange_areas *m, const struct link *const *links,
                           const unsigned char *off, struct entry *entries)
{
    size_t count = 0;
    for (size_t i = 0; i < m->block_count; i++) {
        const struct exchange_block *b = &m->blocks[i];
        if (exchange_link_proved(links[i]))
            continue;
        for (uint32_t r = b->row; r < b->row + b->rows; r++)
            for (uint32_t s = b->column; s < b->column + b->columns; s++) {
                if (!off[m->input[r]] && !off[m->input[s]])
                    continue;
                if (entries)
                    entries[count] = (struct entry){
                        .receiver = element_at(m->tree, links[i]->receiver, r),
                        .emitter = element_at(m->tree, links[i]->emitter, s),
                        .block = i,
                        .at = b->at + (size_t)(r - b->row) * b->columns + (s - b->column)};
                count++;
            }
    }
    return count;
}

static void find_entries(const void *looking, size_t from, size_t to)
{
    const struct looking *l = looking;
    const struct exchange_tree *t = l->areas->tree;
    struct sight_scratch *scratch = &l->scratch[thread_pool_number()].sight;
    for (size_t i = from; i < to; i++) {
        struct entry *e = &l->entries[i];
        e->value = sight_pair(&t->h.elements[e->receiver], &t->h.elements[e->emitter], t, NULL,
                              scratch, 1, &e->error);
    }
}

/* Is no more of it wanted, after this share and so many rays? */
static int is_stopped(const struct exchange_areas *m, const struct exchange_aim *how,
                      const struct link *const *links, double share, uint64_t rays)
{
    return (how->tell && how->tell(how->context, share))
           || (how->state && exchange_state_ask(how->state)
               && exchange_state_put(how->state, m, links, m->block_count, rays));
}

/* Returns 0, or -1 on all ranks when it is not wanted any more. */
static int look_at_all(const struct looking *all, size_t count, const struct exchange_aim *how,
                       const struct link *const *links)
{
    const struct exchange_areas *m = all->areas;
    const uint64_t before = rays_count(m->tree->rays).rays;
    for (size_t from = 0; from < count; from += AT_A_TIME) {
        const size_t n = count - from < AT_A_TIME ? count - from : AT_A_TIME;
        const struct looking some = {m, all->scratch, all->entries + from};
        ranks_loop_run(m->ranks, RANKS_VALUES, how->threads, n, 1, find_entries, &some,
                       some.entries, sizeof *some.entries);
        if (is_stopped(m, how, links, (double)(from + n) / (double)count,
                       rays_count(m->tree->rays).rays - before))
            return -1;
    }
    return 0;
}

/* What the entries came to takes the place of what was there. */
static void put_entries(struct exchange_areas *m, const struct entry *entries, size_t count)
{
    const struct element *elements = m->tree->h.elements;
    for (size_t i = 0; i < count; i++) {
        const struct entry *e = &entries[i];
        const double least = fmin(elements[e->receiver].area, elements[e->emitter].area);
        struct exchange_block *b = &m->blocks[e->block];
        m->values[e->at] = e->value;
        b->error = fmax(b->error, e->error / least);
    }
}

/* exchange_again, of blocks of these links. */
static int look_again(struct exchange_areas *m, const struct link *const *links,
                      const unsigned char *off, const struct exchange_aim *how)
{
    const size_t count = list_entries(m, links, off, NULL);
    struct looking l = {m, calloc((size_t)how->threads, sizeof *l.scratch),
                        malloc((count + 1) * sizeof *l.entries)};
    int failed = !l.scratch || !l.entries;
    for (int k = 0; k < how->threads && !failed; k++)
        failed = exchange_scratch_open(&l.scratch[k], &m->limits) < 0;
    failed = ranks_any(m->ranks, failed);
    if (!failed) {
        (void)list_entries(m, links, off, l.entries);
        failed = look_at_all(&l, count, how, links) < 0;
    }
    if (!failed)
        put_entries(m, l.entries, count);
    for (int k = 0; k < how->threads && l.scratch; k++)
        exchange_scratch_close(&l.scratch[k]);
    free(l.scratch);
    free(l.entries);
    return failed ? -1 : 0;
}

int exchange_again(struct exchange_areas *m, const struct refinement *refinement,
                   const unsigned char *off, const struct exchange_aim *how)
{
    const struct link **links = malloc((m->block_count + 1) * sizeof *links);
    int status = ranks_any(m->ranks, !links) ? -1 : 0;
    if (status == 0) {
        struct exchange_tiles t = exchange_tiles(m, refinement);
        for (size_t i = 0; exchange_tiles_next(&t); i++)
            links[i] = t.link;
        status = look_again(m, (const struct link *const *)links, off, how);
    }
    free(links);
    return status;
}
