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
#include "engine/exchange_tiles.h"
#include "util/thread_pool.h"

/* Blocks between two times that somebody is told: a hundredth of them, but no fewer than that. */
enum { TELLINGS = 100, LEAST_TOLD = 1024 };

/* What blocks are filled from. */
struct filling {
    const struct exchange_areas *areas;
    const struct link **links; /* [block] */
    const struct exchange_faces *faces;
    struct exchange_scratch *scratch; /* [thread] */
    size_t from;                      /* the first block at hand */
};

double exchange_tile_fill(const struct exchange_areas *m, const struct exchange_faces *faces,
                          const struct exchange_block *b, const struct link *link,
                          struct exchange_scratch *scratch, double *values)
{
    const struct element *elements = m->tree->h.elements;
    const struct exchange_pair pair = {m->tree,
                                       &elements[link->receiver],
                                       &elements[link->emitter],
                                       {b->row, b->row + b->rows},
                                       {b->column, b->column + b->columns}};
    return exchange_block_fill(faces, &pair, link, scratch, values);
}

static void fill_blocks(const void *filling, size_t from, size_t to)
{
    const struct filling *f = filling;
    const struct exchange_areas *m = f->areas;
    for (size_t i = f->from + from; i < f->from + to; i++) {
        struct exchange_block *b = &m->blocks[i]; /* no other thread's */
        b->error = exchange_tile_fill(m, f->faces, b, f->links[i],
                                      &f->scratch[thread_pool_number()], m->values + b->at);
    }
}

static int fill(struct exchange_areas *m, const struct link **links, const struct exchange_aim *how)
{
    const int threads = how->threads;
    struct exchange_faces faces = {.all = NULL};
    struct exchange_scratch *scratch = calloc((size_t)threads, sizeof *scratch);
    struct filling f = {m, links, &faces, scratch, 0};
    size_t step = m->block_count / TELLINGS > LEAST_TOLD ? m->block_count / TELLINGS : LEAST_TOLD;
    int failed = !scratch || exchange_faces_open(&faces, m->tree) < 0;
    for (int t = 0; t < threads && !failed; t++)
        failed = exchange_scratch_open(&scratch[t], TILE, &m->limits) < 0;
    for (; f.from < m->block_count && !failed; f.from += step) {
        size_t left = m->block_count - f.from;
        failed = f.from && how->tell
                 && how->tell(how->context, (double)m->blocks[f.from].at / (double)m->value_count);
        if (!failed)
            thread_pool_run(threads, left < step ? left : step, 32, fill_blocks, &f);
    }
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

/* All tiles, and what they stand for. */
static int keep_values(struct exchange_areas *m, const struct exchange_aim *how)
{
    struct exchange_tiles t = exchange_tiles(m, m->refinement);
    while (exchange_tiles_next(&t))
        m->block_count++;
    const struct link **links;
    links = malloc((m->block_count + 1) * sizeof *links);
    m->blocks = malloc((m->block_count + 1) * sizeof *m->blocks);
    m->values = malloc((t.values + 1) * sizeof *m->values);
    int status = -1;
    if (links && m->blocks && m->values && m->block_count <= UINT32_MAX / 2) {
        t = exchange_tiles(m, m->refinement);
        for (size_t i = 0; exchange_tiles_next(&t); i++) {
            m->blocks[i] = t.is;
            links[i] = t.link;
        }
        status = make_index(m) < 0 ? -1 : fill(m, links, how);
    }
    free(links);
    m->refinement = NULL;
    return status;
}

int exchange_areas_open(struct exchange_areas *m, const struct exchange_tree *tree,
                        const struct scene *scene, const struct refinement *refinement,
                        const struct exchange_aim *how)
{
    *m = (struct exchange_areas){.tree = tree,
                                 .faces = tree->h.face_count,
                                 .inputs = scene->input_count,
                                 .rows = how->rows ? how->rows : scene->input_count,
                                 .limits = sight_limits_for(how->tolerance, tree->h.face_count),
                                 .refinement = refinement};
    if (find_inputs(m, scene) == 0) {
        struct exchange_tiles t = exchange_tiles(m, refinement);
        while (exchange_tiles_next(&t))
            ;
        m->link_count = t.links;
        m->value_count = t.values;
        if (!how->keep || keep_values(m, how) == 0)
            return 0;
    }
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
    for (uint32_t i = 0; i < m->rows && m->values && sum && met; i++) {
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
