/* exchange_areas.c - from links to the exchange areas of all pairs of faces.
 *
 * A link of two groups stands for a block of pairs, cut into tiles; what stands in a tile is
 * exchange_blocks.c's.
 * Invariant: one value per pair serves both rows, so A_i F_ij = A_j F_ji to rounding.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "engine/exchange_areas.h"
#include "engine/exchange_blocks.h"
#include "util/thread_pool.h"

/* Blocks are no larger, so that a column's values are in the cache while its neighbours' rows
 * are written. */
enum { TILE = 64 };

/* One of the two links between the same two elements: the one whose receiver stands later in the
 * tree's order. */
static int link_counts(const struct exchange_tree *t, const struct link *link)
{
    return hierarchy_range(&t->h, link->receiver).from > hierarchy_range(&t->h, link->emitter).from;
}

/* The blocks of a link, with the link that each is of; NULL: count them only. */
static void add_tiles(struct exchange_areas *m, const struct link *link, const struct link **links)
{
    struct face_range r = hierarchy_range(&m->tree->h, link->receiver),
                      s = hierarchy_range(&m->tree->h, link->emitter);
    for (uint32_t i = r.from; i < r.to; i += TILE)
        for (uint32_t j = s.from; j < s.to; j += TILE) {
            struct exchange_block b = {i,
                                       r.to - i < TILE ? r.to - i : TILE,
                                       j,
                                       s.to - j < TILE ? s.to - j : TILE,
                                       m->value_count,
                                       0};
            if (links) {
                m->blocks[m->block_count] = b;
                links[m->block_count] = link;
            }
            m->block_count++;
            m->value_count += (size_t)b.rows * b.columns;
        }
}

/* What blocks are filled from. */
struct filling {
    const struct exchange_areas *areas;
    const struct link **links; /* [block] */
    const struct exchange_faces *faces;
    struct exchange_scratch *scratch; /* [thread] */
    double near;
};

static void fill_blocks(const void *filling, size_t from, size_t to)
{
    const struct filling *f = filling;
    const struct exchange_areas *m = f->areas;
    const struct element *elements = m->tree->h.elements;
    for (size_t i = from; i < to; i++) {
        struct exchange_block *b = &m->blocks[i]; /* no other thread's */
        const struct exchange_pair pair = {m->tree,
                                           &elements[f->links[i]->receiver],
                                           &elements[f->links[i]->emitter],
                                           {b->row, b->row + b->rows},
                                           {b->column, b->column + b->columns},
                                           f->near};
        b->error = exchange_block_fill(f->faces, &pair, f->links[i],
                                       &f->scratch[thread_pool_number()], m->values + b->at);
    }
}

static int fill(struct exchange_areas *m, const struct link **links, double near, double tolerance,
                int threads)
{
    const struct sight_limits limits = sight_limits_for(tolerance, m->faces);
    struct exchange_faces faces = {.all = NULL};
    struct exchange_scratch *scratch = calloc((size_t)threads, sizeof *scratch);
    const struct filling f = {m, links, &faces, scratch, near};
    int failed = !scratch || exchange_faces_open(&faces, m->tree) < 0;
    for (int t = 0; t < threads && !failed; t++)
        failed = exchange_scratch_open(&scratch[t], TILE, &limits) < 0;
    if (!failed)
        thread_pool_run(threads, m->block_count, 32, fill_blocks, &f);
    for (int t = 0; t < threads && scratch; t++)
        exchange_scratch_close(&scratch[t]);
    free(scratch);
    exchange_faces_close(&faces);
    return failed ? -1 : 0;
}

/* Which blocks hold a place. */
static int make_index(struct exchange_areas *m)
{
    m->entry = calloc(m->faces + 2, sizeof *m->entry);
    if (!m->entry)
        return -1;
    for (size_t i = 0; i < m->block_count; i++) {
        const struct exchange_block *b = &m->blocks[i];
        for (uint32_t k = 0; k < b->rows; k++)
            m->entry[b->row + k + 2]++;
        for (uint32_t k = 0; k < b->columns; k++)
            m->entry[b->column + k + 2]++;
    }
    for (uint32_t k = 2; k < m->faces + 2; k++)
        m->entry[k] += m->entry[k - 1];
    m->index = malloc((m->entry[m->faces + 1] + 1) * sizeof *m->index);
    if (!m->index)
        return -1;
    for (size_t i = 0; i < m->block_count; i++) {
        const struct exchange_block *b = &m->blocks[i];
        for (uint32_t k = 0; k < b->rows; k++)
            m->index[m->entry[b->row + k + 1]++] = (uint32_t)(2 * i);
        for (uint32_t k = 0; k < b->columns; k++)
            m->index[m->entry[b->column + k + 1]++] = (uint32_t)(2 * i + 1);
    }
    return 0;
}

/* The rows: which faces are parts of which input face. */
static int find_inputs(struct exchange_areas *m, const struct scene *scene)
{
    m->input = malloc(m->faces * sizeof *m->input);
    m->area = calloc(m->inputs + 1, sizeof *m->area);
    m->first = malloc((m->inputs + 1) * sizeof *m->first);
    m->next = malloc(m->faces * sizeof *m->next);
    if (!m->input || !m->area || !m->first || !m->next)
        return -1;
    memset(m->first, 0xff, (m->inputs + 1) * sizeof *m->first);
    for (uint32_t p = m->faces; p-- > 0;) {
        uint32_t face = m->tree->h.order[p], i = scene->faces[face].input;
        m->input[p] = i;
        m->next[p] = m->first[i];
        m->first[i] = p;
        m->area[i] += m->tree->h.elements[m->tree->h.face_element[face]].area;
    }
    return 0;
}

int exchange_areas_open(struct exchange_areas *m, const struct exchange_tree *tree,
                        const struct scene *scene, const struct refinement *refinement, double near,
                        double tolerance, int threads)
{
    memset(m, 0, sizeof *m);
    m->tree = tree;
    m->faces = tree->h.face_count;
    m->inputs = scene->input_count;
    for (size_t i = 0; i < refinement->link_count; i++)
        if (link_counts(tree, &refinement->links[i]))
            add_tiles(m, &refinement->links[i], NULL);
    const struct link **links;
    links = malloc((m->block_count + 1) * sizeof *links);
    m->blocks = malloc((m->block_count + 1) * sizeof *m->blocks);
    if (!links || !m->blocks || m->block_count > UINT32_MAX / 2 || find_inputs(m, scene) < 0)
        goto fail;
    m->block_count = m->value_count = 0;
    for (size_t i = 0; i < refinement->link_count; i++)
        if (link_counts(tree, &refinement->links[i])) {
            m->link_count++;
            add_tiles(m, &refinement->links[i], links);
        }
    m->values = malloc((m->value_count + 1) * sizeof *m->values);
    if (!m->values || make_index(m) < 0 || fill(m, links, near, tolerance, threads) < 0)
        goto fail;
    free(links);
    return 0;
fail:
    free(links);
    exchange_areas_close(m);
    return -1;
}

void exchange_areas_close(struct exchange_areas *m)
{
    free(m->input);
    free(m->area);
    free(m->first);
    free(m->next);
    free(m->blocks);
    free(m->values);
    free(m->entry);
    free(m->index);
    memset(m, 0, sizeof *m);
}

double exchange_areas_row(const struct exchange_areas *m, uint32_t i, const double *scale,
                          double *row)
{
    double sum = 0, own = scale ? scale[i] : 1;
    for (uint32_t p = m->first[i]; p != UINT32_MAX; p = m->next[p])
        for (size_t at = m->entry[p]; at < m->entry[p + 1]; at++) {
            const struct exchange_block *b = &m->blocks[m->index[at] / 2];
            int column = m->index[at] & 1;
            const double *v =
                m->values + b->at + (column ? p - b->column : (size_t)(p - b->row) * b->columns);
            uint32_t n = column ? b->rows : b->columns, step = column ? b->columns : 1;
            const uint32_t *input = m->input + (column ? b->row : b->column);
            for (uint32_t k = 0; k < n; k++, v += step) {
                double e = scale ? *v * (own * scale[input[k]]) : *v;
                row[input[k]] += e;
                sum += e;
            }
        }
    return sum;
}

void exchange_areas_sums(const struct exchange_areas *m, const double *scale, double *sums)
{
    double column[TILE], times_row[TILE], times_column[TILE];
    memset(sums, 0, m->inputs * sizeof *sums);
    for (size_t b = 0; b < m->block_count; b++) {
        const struct exchange_block *block = &m->blocks[b];
        const double *v = m->values + block->at;
        for (uint32_t i = 0; i < block->rows; i++)
            times_row[i] = scale ? scale[m->input[block->row + i]] : 1;
        for (uint32_t j = 0; j < block->columns; j++) {
            times_column[j] = scale ? scale[m->input[block->column + j]] : 1;
            column[j] = 0;
        }
        for (uint32_t i = 0; i < block->rows; i++, v += block->columns) {
            double sum = 0, own = times_row[i];
#pragma omp simd reduction(+ : sum)
            for (uint32_t j = 0; j < block->columns; j++) {
                sum += v[j] * times_column[j];
                column[j] += v[j] * own;
            }
            sums[m->input[block->row + i]] += sum;
        }
        for (uint32_t j = 0; j < block->columns; j++)
            sums[m->input[block->column + j]] += column[j];
    }
}

double exchange_areas_error(const struct exchange_areas *m)
{
    double *sum = calloc(m->inputs + 1, sizeof *sum), most = 0;
    uint32_t *met = malloc((m->inputs + 1) * sizeof *met), count;
    for (uint32_t i = 0; i < m->inputs && sum && met; i++) {
        count = 0;
        for (uint32_t p = m->first[i]; p != UINT32_MAX; p = m->next[p])
            for (size_t at = m->entry[p]; at < m->entry[p + 1]; at++) {
                const struct exchange_block *b = &m->blocks[m->index[at] / 2];
                int column = m->index[at] & 1;
                const uint32_t *input = m->input + (column ? b->row : b->column);
                for (uint32_t k = 0; b->error > 0 && k < (column ? b->rows : b->columns); k++) {
                    if (!(sum[input[k]] > 0))
                        met[count++] = input[k];
                    sum[input[k]] += b->error;
                }
            }
        while (count-- > 0) {
            most = fmax(most, sum[met[count]] / m->area[i]);
            sum[met[count]] = 0;
        }
    }
    most = sum && met ? most : -1;
    free(sum);
    free(met);
    return most;
}
