/* exchange_areas.c - from links to the exchange areas of all pairs of faces.
 *
 * A link of two groups stands for a block of pairs, cut into tiles; what stands in a tile is
 * exchange_blocks.c's.
 * Invariant: one value per pair serves both rows, so A_i F_ij = A_j F_ji to rounding.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "engine/exchange_areas.h"
#include "engine/exchange_fill.h"
#include "engine/exchange_tiles.h"
#include "util/array.h"

static struct exchange_pair pair_of(const struct exchange_areas *m, const struct exchange_block *b,
                                    const struct link *link)
{
    const struct element *elements = m->tree->h.elements;
    return (struct exchange_pair){m->tree,
                                  &elements[link->receiver],
                                  &elements[link->emitter],
                                  {b->row, b->row + b->rows},
                                  {b->column, b->column + b->columns}};
}

double exchange_tile_fill(const struct exchange_areas *m, const struct exchange_block *b,
                          const struct link *link, struct exchange_scratch *scratch, double *values)
{
    const struct exchange_pair pair = pair_of(m, b, link);
    return exchange_block_fill(&m->shapes, &pair, link, scratch, values);
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
        m->area[i] += hierarchy_surface(&m->tree->h, face)->area;
    }
    return 0;
}

/* Which blocks there are, and which of them are kept: of those that may be made anew the first
 * ones, as far as `keep` goes. `links`: by block. Returns 0, or -1 when out of memory. */
static int deal_out(struct exchange_areas *m, const struct refinement *refinement, size_t keep,
                    const struct link **links)
{
    struct exchange_tiles t = exchange_tiles(m, refinement);
    const struct link *last = NULL;
    size_t capacity = 0;
    for (size_t i = 0; exchange_tiles_next(&t); i++) {
        struct exchange_block *b = &m->blocks[i];
        size_t size = (size_t)t.is.rows * t.is.columns;
        *b = t.is;
        b->at = m->kept;
        links[i] = t.link;
        if (!exchange_link_clear(m->tree, t.link)) {
            m->kept += size;
        } else if (size <= keep) {
            m->kept += size;
            keep -= size;
        } else {
            if (t.link != last) {
                if (array_reserve(&m->links, m->links_anew + 1, &capacity, sizeof *m->links) < 0)
                    return -1;
                m->links[m->links_anew++] = *t.link;
            }
            last = t.link;
            b->anew = m->links_anew;
        }
    }
    return 0;
}

/* All blocks, and what those that are kept stand for. */
static int keep_values(struct exchange_areas *m, const struct refinement *refinement,
                       const struct exchange_aim *how)
{
    const struct link **links;
    links = malloc((m->block_count + 1) * sizeof *links);
    m->blocks = malloc((m->block_count + 1) * sizeof *m->blocks);
    int status = -1;
    if (links && m->blocks && m->block_count <= UINT32_MAX / 2
        && deal_out(m, refinement, how->keep, links) == 0) {
        m->values = malloc((m->kept + 1) * sizeof *m->values);
        status = !m->values || make_index(m) < 0 ? -1 : 0;
    }
    status = ranks_any(m->ranks, status < 0) ? -1 : exchange_fill(m, links, how);
    free(links);
    return status;
}

int exchange_areas_open(struct exchange_areas *m, const struct exchange_tree *tree,
                        const struct scene *scene, const struct refinement *refinement,
                        const struct exchange_aim *how)
{
    *m = (struct exchange_areas){
        .tree = tree,
        .faces = tree->h.face_count,
        .inputs = scene->input_count,
        .rows = how->rows ? how->rows : scene->input_count,
        .limits = sight_limits_for(how->tolerance, scene->input_count, tree->h.face_count),
        .refinement = how->stream ? refinement : NULL,
        .ranks = how->ranks};
    const int out = find_inputs(m, scene) < 0 || exchange_faces_open(&m->shapes, tree) < 0;
    if (!ranks_any(m->ranks, out)) {
        struct exchange_tiles t = exchange_tiles(m, refinement);
        while (exchange_tiles_next(&t))
            m->block_count += !how->stream;
        m->link_count = t.links;
        m->value_count = t.values;
        if (how->stream || keep_values(m, refinement, how) == 0)
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
    free(m->links);
    free(m->entry);
    free(m->index);
    exchange_faces_close(&m->shapes);
    memset(m, 0, sizeof *m);
}

/* The line of block b that place p is: its values, each so many after the one before. */
static const double *line_of(const struct exchange_areas *m, const struct exchange_block *b,
                             uint32_t p, int column, double room[TILE], uint32_t *step)
{
    *step = column && !b->anew ? b->columns : 1;
    if (!b->anew)
        return m->values + b->at + (column ? p - b->column : (size_t)(p - b->row) * b->columns);
    const struct exchange_pair pair = pair_of(m, b, &m->links[b->anew - 1]);
    clear_line(&m->shapes, &pair, m->limits.tolerance, p, column, room);
    return room;
}

double exchange_areas_row(const struct exchange_areas *m, uint32_t i, const double *scale,
                          double *row)
{
    double sum = 0, own = scale ? scale[i] : 1, room[TILE];
    for (uint32_t p = m->first[i]; p != UINT32_MAX; p = m->next[p])
        for (size_t at = m->entry[p]; at < m->entry[p + 1]; at++) {
            const struct exchange_block *b = &m->blocks[m->index[at] / 2];
            int column = m->index[at] & 1;
            uint32_t n = column ? b->rows : b->columns, step;
            const uint32_t *input = m->input + (column ? b->row : b->column);
            const double *v = line_of(m, b, p, column, room, &step);
            for (uint32_t k = 0; k < n; k++, v += step) {
                double e = scale ? *v * (own * scale[input[k]]) : *v;
                row[input[k]] += e;
                sum += e;
            }
        }
    return sum;
}

/* Adds what values of a block may be wrong by, as the row of place p has them, to sums by polygon
 * (m2); index: as in exchange_areas.index. met[count]: polygons that have a sum. Returns their
 * number. */
static uint32_t add_errors(const struct exchange_areas *m, uint32_t p, uint32_t index, double *sum,
                           uint32_t *met, uint32_t count)
{
    const struct exchange_block *b = &m->blocks[index / 2];
    const int column = index & 1;
    const uint32_t from = column ? b->row : b->column,
                   past = from + (column ? b->rows : b->columns);
    const double own = exchange_tree_face(m->tree, p)->area;
    for (uint32_t place = from; place < past && b->error > 0; place++) {
        const uint32_t input = m->input[place];
        if (!(sum[input] > 0))
            met[count++] = input;
        sum[input] += b->error * fmin(own, exchange_tree_face(m->tree, place)->area);
    }
    return count;
}

double exchange_areas_error(const struct exchange_areas *m)
{
    double *sum = calloc(m->inputs + 1, sizeof *sum), most = 0;
    uint32_t *met = malloc((m->inputs + 1) * sizeof *met), count;
    const int me = ranks_number(m->ranks);
    const uint32_t to = (uint32_t)ranks_part(m->ranks, m->rows, me + 1);
    for (uint32_t i = (uint32_t)ranks_part(m->ranks, m->rows, me);
         i < to && m->blocks && sum && met; i++) {
        count = 0;
        for (uint32_t p = m->first[i]; p != UINT32_MAX; p = m->next[p])
            for (size_t at = m->entry[p]; at < m->entry[p + 1]; at++)
                count = add_errors(m, p, m->index[at], sum, met, count);
        while (count-- > 0) {
            most = fmax(most, sum[met[count]] / m->area[i]);
            sum[met[count]] = 0;
        }
    }
    most = sum && met ? most : INFINITY;
    ranks_most(m->ranks, RANKS_VALUES, &most, 1);
    most = isinf(most) ? -1 : most;
    free(sum);
    free(met);
    return most;
}
