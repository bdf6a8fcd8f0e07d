/* face_paths.c - see face_paths.h.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include "particles/face_paths.h"
#include "particles/paths.h"
#include "util/ranks_loop.h"

enum { BLOCKS = 1 << 13 }; /* traced before their sums are added */

int face_paths_open(struct face_paths *p, const struct tracer *t, uint64_t stream, int replicates)
{
    uint32_t faces = t->hierarchy->face_count;
    size_t values = (size_t)faces * t->bands;
    *p = (struct face_paths){.faces = faces, .bands = t->bands, .stream = stream};
    p->share = calloc(faces, sizeof *p->share);
    int failed = !p->share;
    for (int half = 0; half < PATH_HALVES; half++) {
        p->sum[half] = calloc(values, sizeof *p->sum[half]);
        p->square[half] = calloc(values, sizeof *p->square[half]);
        failed |= !p->sum[half] || !p->square[half];
    }
    for (int r = 0; r < REPLICATES && replicates; r++) {
        p->replicate[r] = calloc(values, sizeof *p->replicate[r]);
        failed |= !p->replicate[r];
    }
    if (failed) {
        face_paths_close(p);
        return -1;
    }
    double all = 0;
    for (uint32_t i = 0; i < faces; i++) {
        double each = tracer_reflectance(t, i) * tracer_surface(t, i)->area;
        p->share[i] = cbrt(each * each);
        all += p->share[i];
    }
    for (uint32_t i = 0; i < faces && all > 0; i++)
        p->share[i] /= all;
    return 0;
}

void face_paths_close(struct face_paths *p)
{
    free(p->share);
    for (int half = 0; half < PATH_HALVES; half++) {
        free(p->sum[half]);
        free(p->square[half]);
    }
    for (int r = 0; r < REPLICATES; r++)
        free(p->replicate[r]);
    *p = (struct face_paths){0};
}

/* PATH_BLOCK paths of one face, from number `first` on. */
struct block {
    uint64_t first, rays;
    uint32_t face;
    double sum[PATH_HALVES][3], square[PATH_HALVES][3], replicate[REPLICATES][3];
};

static void trace(struct block *b, const struct tracer *t, uint64_t stream, int replicates)
{
    uint32_t shift[REPLICATES][SOBOL_COORDINATES];
    for (uint64_t r = 0; r < REPLICATES && replicates; r++)
        sobol_sequence_shifts((stream + b->face) * REPLICATES + r, shift[r]);
    for (uint64_t i = b->first; i < b->first + PATH_BLOCK; i++) {
        struct dice dice = replicates ? dice_of_point(t, stream + b->face, i, shift[i % REPLICATES],
                                                      i / REPLICATES)
                                      : dice_of(stream + b->face, i);
        double u = dice_throw(&dice), v = dice_throw(&dice), p[3], h[3] = {0, 0, 0};
        tracer_point(t, b->face, u, v, p);
        path_irradiance(t, b->face, p, &dice, h, &b->rays);
        for (uint32_t k = 0; k < t->bands; k++) {
            b->sum[i % PATH_HALVES][k] += h[k];
            b->square[i % PATH_HALVES][k] += h[k] * h[k];
            b->replicate[i % REPLICATES][k] += h[k];
        }
    }
}

static void add(struct face_paths *p, const struct block *b)
{
    p->rays += b->rays;
    for (int half = 0; half < PATH_HALVES; half++)
        for (uint32_t k = 0; k < p->bands; k++) {
            p->sum[half][(size_t)b->face * p->bands + k] += b->sum[half][k];
            p->square[half][(size_t)b->face * p->bands + k] += b->square[half][k];
        }
    for (int r = 0; r < REPLICATES && p->replicate[r]; r++)
        for (uint32_t k = 0; k < p->bands; k++)
            p->replicate[r][(size_t)b->face * p->bands + k] += b->replicate[r][k];
}

struct blocks {
    const struct tracer *t;
    struct block *blocks;
    uint64_t stream;
    int replicates;
};

static void trace_blocks(const void *blocks, size_t from, size_t to)
{
    const struct blocks *b = blocks;
    for (size_t i = from; i < to; i++)
        trace(&b->blocks[i], b->t, b->stream, b->replicates);
}

/* Trace the blocks, then add them in their order. Returns 0, or -1 when stopped. */
static int flush(struct face_paths *p, const struct tracer *t, struct block *blocks, int count,
                 const struct watch *watch, double share)
{
    const struct blocks all = {t, blocks, p->stream, p->replicate[0] != NULL};
    ranks_loop_run(t->ranks, RANKS_PARTICLES, t->threads, (size_t)count, 16, trace_blocks, &all,
                   blocks, sizeof *blocks);
    for (int i = 0; i < count; i++)
        add(p, &blocks[i]);
    return watch && watch->tell(watch->context, share) ? -1 : 0;
}

int face_paths_trace(struct face_paths *p, const struct tracer *t, uint64_t paths,
                     const struct watch *watch)
{
    uint64_t wanted = 0, done = 0;
    if (paths <= p->paths)
        return 0;
    struct block *blocks = malloc(BLOCKS * sizeof *blocks);
    if (ranks_any(t->ranks, !blocks)) {
        free(blocks);
        return -1;
    }
    for (uint32_t i = 0; i < p->faces; i++)
        wanted += face_paths_count(p, i, paths) - face_paths_count(p, i, p->paths);
    int waiting = 0, stopped = 0;
    for (uint32_t i = 0; i < p->faces && !stopped; i++) {
        uint64_t to = face_paths_count(p, i, paths);
        for (uint64_t at = face_paths_count(p, i, p->paths); at < to && !stopped;
             at += PATH_BLOCK, done += PATH_BLOCK) {
            blocks[waiting++] = (struct block){.first = at, .face = i};
            if (waiting < BLOCKS)
                continue;
            stopped = flush(p, t, blocks, waiting, watch, (double)done / (double)wanted);
            waiting = 0;
        }
    }
    stopped = stopped || flush(p, t, blocks, waiting, watch, 1);
    free(blocks);
    p->paths = paths;
    return stopped ? -1 : 0;
}
