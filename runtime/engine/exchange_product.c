/* exchange_product.c - the matrix of exchange areas times columns.
 *
 * Tiles are dealt out to a fixed number of lanes, each with sums of its own, which are added up in
 * their order: so the result does not depend on who worked on what. Each tile serves both ways
 * round, and is forgotten: memory is that of the links and of the lanes' sums.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "engine/exchange_blocks.h"
#include "engine/exchange_product.h"
#include "engine/exchange_tiles.h"
#include "util/thread_pool.h"

/* COLUMNS: at a time. */
enum { LANES = 16, COLUMNS = 8 };

struct product {
    const struct exchange_areas *areas;
    const struct exchange_faces *faces; /* where values are not kept */
    struct exchange_scratch *scratch;   /* [thread] */
    double *values;                     /* [thread][TILE * TILE] */
    double *sums;                       /* [LANES][inputs][columns] */
    const double *x;                    /* [inputs][across] */
    uint32_t columns, across;
};

/* One column's part of a tile, both ways round. */
static void add_column(const struct product *p, const struct exchange_block *b,
                       const double *restrict v, uint32_t c, double *sums)
{
    const uint32_t *input = p->areas->input, n = p->columns;
    double x[TILE], y[TILE] = {0};
    for (uint32_t j = 0; j < b->columns; j++)
        x[j] = p->x[(size_t)input[b->column + j] * p->across + c];
    for (uint32_t i = 0; i < b->rows; i++, v += b->columns) {
        double sum = 0, own = p->x[(size_t)input[b->row + i] * p->across + c];
#pragma omp simd reduction(+ : sum)
        for (uint32_t j = 0; j < b->columns; j++) {
            sum += v[j] * x[j];
            y[j] += v[j] * own;
        }
        sums[(size_t)input[b->row + i] * n + c] += sum;
    }
    for (uint32_t j = 0; j < b->columns; j++)
        sums[(size_t)input[b->column + j] * n + c] += y[j];
}

static void add_tile(const struct product *p, const struct exchange_block *b, const double *v,
                     double *sums)
{
    for (uint32_t c = 0; c < p->columns; c++)
        add_column(p, b, v, c, sums);
}

static void add_lane(const struct product *p, size_t lane)
{
    const struct exchange_areas *m = p->areas;
    double *sums = p->sums + lane * m->inputs * p->columns;
    for (size_t i = lane; m->values && i < m->block_count; i += LANES)
        add_tile(p, &m->blocks[i], m->values + m->blocks[i].at, sums);
    if (m->values)
        return;
    double *values = p->values + (size_t)thread_pool_number() * TILE * TILE;
    struct exchange_scratch *scratch = &p->scratch[thread_pool_number()];
    struct exchange_tiles t = exchange_tiles(m, m->refinement);
    for (size_t i = 0; exchange_tiles_next(&t); i++) {
        if (i % LANES != lane)
            continue;
        (void)exchange_tile_fill(m, p->faces, &t.is, t.link, scratch, values);
        add_tile(p, &t.is, values, sums);
    }
}

static void add_lanes(const void *product, size_t from, size_t to)
{
    for (size_t lane = from; lane < to; lane++)
        add_lane(product, lane);
}

static void run(struct product *p, int threads, double *y)
{
    const size_t inputs = p->areas->inputs, size = inputs * p->columns;
    memset(p->sums, 0, LANES * size * sizeof *p->sums);
    thread_pool_run(threads, LANES, 1, add_lanes, p);
    for (size_t i = 0; i < inputs; i++)
        for (uint32_t c = 0; c < p->columns; c++) {
            double sum = 0;
            for (size_t lane = 0; lane < LANES; lane++)
                sum += p->sums[lane * size + i * p->columns + c];
            y[i * p->across + c] = sum;
        }
}

int exchange_product(const struct exchange_areas *m, int threads, uint32_t columns, const double *x,
                     double *y)
{
    struct exchange_faces faces = {.all = NULL};
    size_t most = columns < COLUMNS ? columns : COLUMNS, workers = (size_t)threads;
    struct product p = {.areas = m,
                        .faces = &faces,
                        .scratch = calloc(workers, sizeof *p.scratch),
                        .values = malloc(workers * TILE * TILE * sizeof *p.values),
                        .sums = malloc((LANES * most * m->inputs + 1) * sizeof *p.sums),
                        .across = columns};
    int failed = !p.scratch || !p.values || !p.sums
                 || (!m->values && exchange_faces_open(&faces, m->tree) < 0);
    for (size_t t = 0; t < workers && !failed && !m->values; t++)
        failed = exchange_scratch_open(&p.scratch[t], TILE, &m->limits) < 0;
    for (uint32_t c = 0; c < columns && !failed; c += COLUMNS) {
        p.columns = columns - c < COLUMNS ? columns - c : COLUMNS;
        p.x = x + c;
        run(&p, threads, y + c);
    }
    for (size_t t = 0; t < workers && p.scratch; t++)
        exchange_scratch_close(&p.scratch[t]);
    free(p.scratch);
    free(p.values);
    free(p.sums);
    exchange_faces_close(&faces);
    return failed ? -1 : 0;
}
