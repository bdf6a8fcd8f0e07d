/* exchange_product.c - the matrix of exchange areas times columns.
 *
 * Tiles are dealt out to a fixed number of lanes, each with sums of its own, which are added up in
 * their order: so the result does not depend on who, of threads or of ranks, worked on what. Each
 * tile serves both ways round; one that is not kept is forgotten then.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "engine/exchange_product.h"
#include "engine/exchange_tiles.h"
#include "util/ranks_loop.h"

/* COLUMNS: at a time. DEAL: tiles that stand one after the other in a lane. */
enum { LANES = 16, COLUMNS = 8, DEAL = 64 };

struct product {
    const struct exchange_areas *areas;
    struct exchange_scratch *scratch; /* [thread] */
    double *values;                   /* [thread][TILE * TILE] */
    double *sums;                     /* [LANES][inputs][columns] */
    const double *x;                  /* [inputs][across] */
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
    double *sums = p->sums + lane * m->inputs * p->columns,
           *values = p->values + (size_t)thread_pool_number() * TILE * TILE;
    struct exchange_scratch *scratch = &p->scratch[thread_pool_number()];
    for (size_t from = lane * DEAL; from < m->block_count; from += LANES * DEAL)
        for (size_t i = from; i < from + DEAL && i < m->block_count; i++) {
            const struct exchange_block *b = &m->blocks[i];
            if (b->anew)
                (void)exchange_tile_fill(m, b, &m->links[b->anew - 1], scratch, values);
            add_tile(p, b, b->anew ? values : m->values + b->at, sums);
        }
    if (!m->refinement)
        return;
    struct exchange_tiles t = exchange_tiles(m, m->refinement);
    for (size_t i = 0; exchange_tiles_next(&t); i++) {
        if (i / DEAL % LANES != lane)
            continue;
        (void)exchange_tile_fill(m, &t.is, t.link, scratch, values);
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
    ranks_loop_run(p->areas->ranks, RANKS_VALUES, threads, LANES, 1, add_lanes, p, p->sums,
                   size * sizeof *p->sums);
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
    size_t most = columns < COLUMNS ? columns : COLUMNS, workers = (size_t)threads;
    struct product p = {.areas = m,
                        .scratch = calloc(workers, sizeof *p.scratch),
                        .values = malloc(workers * TILE * TILE * sizeof *p.values),
                        .sums = malloc((LANES * most * m->inputs + 1) * sizeof *p.sums),
                        .across = columns};
    int failed = !p.scratch || !p.values || !p.sums;
    for (size_t t = 0; t < workers && !failed && (m->refinement || m->links_anew); t++)
        failed = exchange_scratch_open(&p.scratch[t], &m->limits) < 0;
    failed = ranks_any(m->ranks, failed);
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
    return failed ? -1 : 0;
}

int exchange_sums(const struct exchange_areas *m, int threads, const double *x, double *sums)
{
    double *ones = x ? NULL : malloc((m->inputs + 1) * sizeof *ones);
    for (uint32_t i = 0; i < m->inputs && ones; i++)
        ones[i] = 1;
    int status =
        ranks_any(m->ranks, !x && !ones) ? -1 : exchange_product(m, threads, 1, x ? x : ones, sums);
    free(ones);
    return status;
}
