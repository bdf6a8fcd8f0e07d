/* mend_sums.c - see mend_sums.h.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "engine/leaf_count.h"
#include "engine/mend_sums.h"
#include "hierarchy/children_first.h"
#include "util/thread_pool.h"

enum { RUN = 256 /* elements that a thread takes at once */ };

struct filling {
    const struct mend_sums *sums;
    const double *irradiance;
};

/* What the replicates counted on a face. */
static void take_face(const struct mend_sums *m, uint32_t element, uint32_t face)
{
    const size_t values = (size_t)m->places.built * m->bands;
    for (uint32_t r = 0; r < REPLICATES; r++)
        for (uint32_t k = 0; k < m->bands; k++)
            m->replicate[r * values + mend_at(m, element, k)] =
                tally_face(m->tally, (int)r, face, k);
}

/* Leaves, and what replicates say of faces, of which others tell theirs; */
static void fill_leaves(const void *filling, size_t from, size_t to)
{
    const struct filling *x = filling;
    const struct mend_sums *m = x->sums;
    const struct hierarchy *h = m->op->hierarchy;
    for (uint32_t e = (uint32_t)from; e < to; e++) {
        const struct element *at = &h->elements[e];
        if (!at->vertices || !mend_is_added(m->op, e))
            continue;
        for (uint32_t k = 0; k < m->bands && !at->children; k++) {
            m->linked[mend_at(m, e, k)] = at->area * x->irradiance[(size_t)e * m->bands + k];
            m->received[mend_at(m, e, k)] = leaf_count(m->tally, h, x->irradiance, e, k);
        }
        if (e < h->built)
            take_face(m, e, at->face);
    }
}

/* or faces as wholes. */
static void fill_faces(const struct mend_sums *m, const double *irradiance)
{
    const struct hierarchy *h = m->op->hierarchy;
    for (uint32_t e = 0; e < h->count; e++) {
        const struct element *at = &h->elements[e];
        if (!at->vertices || !mend_is_added(m->op, e))
            continue;
        const uint32_t whole = h->face_element[at->face];
        for (uint32_t k = 0; k < m->bands && !at->children; k++)
            m->linked[mend_at(m, whole, k)] += at->area * irradiance[(size_t)e * m->bands + k];
        if (e != whole || !tally_holds(m->tally, at->face))
            continue;
        take_face(m, e, at->face);
        for (uint32_t k = 0; k < m->bands; k++)
            m->received[mend_at(m, e, k)] = tally_face_mean(m->tally, at->face, k);
    }
}

/* Once all ranks have all links, each still has counts of its own faces alone, and tells them. */
static void tell_counts(const struct mend_sums *m)
{
    struct ranks *ranks = m->op->shares.ranks;
    const size_t values = (size_t)m->places.built * m->bands;
    if (!m->tally->quarters || m->op->shares.common)
        return;
    ranks_add(ranks, RANKS_PARTICLES, m->received, values);
    ranks_add(ranks, RANKS_PARTICLES, m->replicate, REPLICATES * values);
}

static void sum_children(const struct mend_sums *m, uint32_t e)
{
    const struct hierarchy *h = m->op->hierarchy;
    const struct element *at = &h->elements[e];
    const size_t values = (size_t)m->places.built * m->bands;
    for (uint32_t j = at->child + at->children; j-- > at->child;)
        for (uint32_t k = 0; k < m->bands; k++) {
            m->linked[mend_at(m, e, k)] += m->linked[mend_at(m, j, k)];
            m->received[mend_at(m, e, k)] += m->received[mend_at(m, j, k)];
            for (uint32_t r = 0; r < REPLICATES && j < h->built; r++)
                m->replicate[r * values + mend_at(m, e, k)] +=
                    m->replicate[r * values + mend_at(m, j, k)];
        }
}

/* Sums from there up, of what is this rank's alone; */
static void add_children(const void *sums, uint32_t e)
{
    const struct mend_sums *m = sums;
    if (mend_is_added(m->op, e) && !mend_is_shared(m->op, e))
        sum_children(m, e);
}

/* and then of what all have: each rank tells of its own, to zeros, and all sum in one order, so
 * that these have the bits of one process. */
static void add_told(const struct mend_sums *m)
{
    struct ranks *ranks = m->op->shares.ranks;
    const size_t values = (size_t)m->places.told * m->bands;
    if (!m->places.at)
        return;
    ranks_add(ranks, RANKS_PARTICLES, m->linked, values);
    ranks_add(ranks, RANKS_PARTICLES, m->received, values);
    for (size_t r = 0; r < REPLICATES; r++)
        ranks_add(ranks, RANKS_PARTICLES, &m->replicate[r * m->places.built * m->bands], values);
    for (uint32_t e = m->op->hierarchy->built; e-- > 0;) /* children follow their parents */
        if (mend_is_shared(m->op, e))
            sum_children(m, e);
}

int mend_sums_open(struct mend_sums *m, const struct light_operator *op, const struct tally *tally,
                   enum mend_depth depth, const double *irradiance)
{
    const struct hierarchy *h = op->hierarchy;
    const int threads = op->problem->options.threads;
    *m = (struct mend_sums){.op = op, .tally = tally, .bands = tally->bands};
    if (ranks_any(op->shares.ranks, mend_places_open(&m->places, op) < 0))
        return -1;
    if (depth == MEND_FACES)
        m->places.count = m->places.built;
    const size_t values = (size_t)m->places.count * m->bands + 1,
                 all = (size_t)REPLICATES * m->places.built * m->bands + 1;
    m->linked = calloc(values, sizeof *m->linked);
    m->received = calloc(values, sizeof *m->received);
    m->replicate = calloc(all, sizeof *m->replicate);
    if (ranks_any(op->shares.ranks, !m->linked || !m->received || !m->replicate))
        return -1;
    if (depth == MEND_FACES) {
        fill_faces(m, irradiance);
        tell_counts(m);
        children_first_clusters(h, add_children, m);
    } else {
        const struct filling x = {m, irradiance};
        thread_pool_run(threads, h->count, RUN, fill_leaves, &x);
        children_first(h, threads, add_children, m);
    }
    add_told(m);
    return 0;
}

void mend_sums_close(struct mend_sums *m)
{
    mend_places_close(&m->places);
    free(m->linked);
    free(m->received);
    free(m->replicate);
}

void mend_shares(const struct mend_sums *m, uint32_t e, uint32_t band, double given[MEND_CHILDREN])
{
    const struct element *elements = m->op->hierarchy->elements, *at = &elements[e];
    double linked = 0;
    for (uint32_t c = 0; c < at->children; c++)
        linked += m->linked[mend_at(m, at->child + c, band)];
    for (uint32_t c = 0; c < at->children; c++) {
        uint32_t j = at->child + c;
        given[c] =
            linked > 0 ? m->linked[mend_at(m, j, band)] / linked : elements[j].area / at->area;
    }
}
