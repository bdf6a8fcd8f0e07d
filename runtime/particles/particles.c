/* particles.c - see particles.h.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "kernel/leaf_at.h"
#include "particles/particles.h"
#include "particles/sobol_sequence.h"

enum { BATCH = 1024 };

int tally_open(struct tally *tally, const struct tracer *t, uint64_t stream, int leaves)
{
    *tally = (struct tally){.faces = t->hierarchy->face_count,
                            .elements = t->hierarchy->count,
                            .bands = t->bands,
                            .stream = stream,
                            .power = t->lights.power};
    size_t bands = t->bands;
    tally->face = calloc((size_t)REPLICATES * tally->faces * bands, sizeof *tally->face);
    tally->square = calloc(bands, sizeof *tally->square);
    if (leaves) {
        tally->element = calloc((size_t)tally->elements * bands, sizeof *tally->element);
        tally->first = malloc(tally->elements * sizeof *tally->first);
    }
    if (!tally->face || !tally->square || (leaves && (!tally->element || !tally->first))) {
        tally_close(tally);
        return -1;
    }
    for (uint32_t i = 0; leaves && i < tally->elements; i++) {
        const struct element *e = &t->hierarchy->elements[i];
        tally->first[i] = e->children ? e->child : 0;
    }
    return 0;
}

void tally_close(struct tally *tally)
{
    free(tally->face);
    free(tally->element);
    free(tally->first);
    free(tally->square);
    *tally = (struct tally){0};
}

/* A run of particles of one replicate, and its sums that are no place's. */
struct batch {
    const struct sobol_sequence *sobol;
    uint32_t shift[SOBOL_COORDINATES];
    int replicate;
    uint64_t rays;
    int64_t first[3], second[3]; /* sums of w and w^2, as counts */
};

static void count(struct tally *tally, const struct tracer *t, uint32_t face, const double at[3],
                  const double share[3], struct batch *batch)
{
    _Atomic int64_t *to_face =
        &tally->face[((size_t)batch->replicate * tally->faces + face) * tally->bands];
    _Atomic int64_t *to_leaf = NULL;
    if (tally->element) {
        double weight[4];
        uint32_t leaf = leaf_at_by(t->hierarchy->elements, tally->first,
                                   t->hierarchy->face_element[face], at, weight);
        to_leaf = &tally->element[(size_t)leaf * tally->bands];
    }
    for (uint32_t k = 0; k < tally->bands; k++) {
        int64_t w = (int64_t)(share[k] * PARTICLE_ONE + 0.5);
        batch->first[k] += w;
        batch->second[k] += (int64_t)(share[k] * share[k] * PARTICLE_ONE + 0.5);
        to_face[k] += w;
        if (to_leaf)
            to_leaf[k] += w;
    }
}

/* What decides next about a reflection, in [0, 1): a coordinate of the sequence as far as these go,
 * then the dice. used: how many decisions there have been. */
static double decide(const struct batch *batch, uint64_t index, struct dice *dice, int *used)
{
    const int d = SOBOL_DIMENSIONS + (*used)++;
    if (d >= SOBOL_COORDINATES)
        return dice_throw(dice);
    return sobol_sequence_at(batch->sobol, (uint32_t)index, d, batch->shift[d]);
}

static void trace(struct tally *tally, const struct tracer *t, uint64_t index, struct batch *batch)
{
    struct dice dice = dice_of(tally->stream * REPLICATES + (uint64_t)batch->replicate, index);
    double u[SOBOL_DIMENSIONS], share[3] = {0, 0, 0}, whole = 0, p[3], at[3];
    sobol_sequence_point(batch->sobol, (uint32_t)index, batch->shift, u);
    uint32_t face = lights_choose(&t->lights, u[0]);
    const double *exitance = &t->exitance[(size_t)face * t->bands];
    for (uint32_t k = 0; k < t->bands; k++)
        whole += exitance[k];
    for (uint32_t k = 0; k < t->bands; k++)
        share[k] = exitance[k] / whole;
    tracer_point(t, face, u[1], u[2], p);
    double s = u[3], v = u[4];
    for (int used = 0;;) {
        int64_t met = tracer_step(t, face, p, s, v, at);
        batch->rays++;
        if (met < 0)
            return;
        face = (uint32_t)met;
        count(tally, t, face, at, share, batch);
        const double *rho = &t->reflectance[(size_t)face * t->bands];
        double strongest = 0, left = 0;
        for (uint32_t k = 0; k < t->bands; k++) {
            strongest = share[k] > strongest ? share[k] : strongest;
            share[k] *= rho[k];
            left = share[k] > left ? share[k] : left;
        }
        if (!(decide(batch, index, &dice, &used) * strongest < left))
            return;
        for (uint32_t k = 0; k < t->bands; k++)
            share[k] *= strongest / left;
        s = decide(batch, index, &dice, &used);
        v = decide(batch, index, &dice, &used);
    }
}

/* What batches come to. */
struct sums {
    _Atomic uint64_t rays;
    _Atomic int64_t first[3], second[3];
};

/* Particles from .. to - 1 of every replicate, in batches, each of one replicate; of these every
 * `ranks`th from number `rank` on. */
struct batches {
    struct tally *tally;
    const struct tracer *t;
    const struct sobol_sequence *sobol;
    uint64_t from, to, rank, ranks;
    struct watched_loop *loop;
    struct sums *sums;
};

static void trace_batches(const void *batches, size_t begin, size_t end)
{
    const struct batches *all = batches;
    for (uint64_t i = begin; i < end; i++) {
        const uint64_t b = i * all->ranks + all->rank;
        struct batch batch = {.sobol = all->sobol, .replicate = (int)(b % REPLICATES)};
        uint64_t low = all->from + b / REPLICATES * BATCH,
                 high = low + BATCH < all->to ? low + BATCH : all->to,
                 set = all->tally->stream * REPLICATES + (uint64_t)batch.replicate;
        if (watched_loop_stopped(all->loop))
            continue;
        for (int d = 0; d < SOBOL_COORDINATES; d++)
            batch.shift[d] = (uint32_t)(hash64(set * SOBOL_COORDINATES + (uint64_t)d + 1) >> 32);
        for (uint64_t k = low; k < high; k++)
            trace(all->tally, all->t, k, &batch);
        all->sums->rays += batch.rays;
        for (int k = 0; k < 3; k++) {
            all->sums->first[k] += batch.first[k];
            all->sums->second[k] += batch.second[k];
        }
        watched_loop_tell(all->loop);
    }
}

/* Before all ranks trace their parts: what has been counted stays with the first; */
static void part_counts(struct tally *tally, struct ranks *ranks)
{
    if (ranks_number(ranks) == 0)
        return;
    memset((void *)(uintptr_t)tally->face, 0,
           (size_t)REPLICATES * tally->faces * tally->bands * sizeof *tally->face);
    if (tally->element)
        memset((void *)(uintptr_t)tally->element, 0,
               (size_t)tally->elements * tally->bands * sizeof *tally->element);
}

/* after it all have what all have counted. Counts are integers: their sum has no order. */
static void add_counts(struct tally *tally, struct ranks *ranks, struct sums *sums)
{
    _Static_assert(sizeof(_Atomic int64_t) == sizeof(uint64_t), "counts are sent as they stand");
    uint64_t few[7] = {sums->rays};
    for (int k = 0; k < 3; k++) {
        few[1 + k] = (uint64_t)sums->first[k];
        few[4 + k] = (uint64_t)sums->second[k];
    }
    ranks_add_counts(ranks, RANKS_PARTICLES, few, 7);
    sums->rays = few[0];
    for (int k = 0; k < 3; k++) {
        sums->first[k] = (int64_t)few[1 + k];
        sums->second[k] = (int64_t)few[4 + k];
    }
    ranks_add_counts(ranks, RANKS_PARTICLES, (uint64_t *)(uintptr_t)tally->face,
                     (size_t)REPLICATES * tally->faces * tally->bands);
    if (tally->element)
        ranks_add_counts(ranks, RANKS_PARTICLES, (uint64_t *)(uintptr_t)tally->element,
                         (size_t)tally->elements * tally->bands);
}

int tally_trace(struct tally *tally, const struct tracer *t, uint64_t particles,
                const struct watch *watch)
{
    uint64_t from = tally->particles, to = from + particles,
             count = (particles + BATCH - 1) / BATCH * REPLICATES;
    tally->particles = to;
    if (!(tally->power > 0))
        return 0;
    struct sobol_sequence sobol;
    sobol_sequence_open(&sobol);
    const uint64_t rank = (uint64_t)ranks_number(t->ranks), ranks = (uint64_t)ranks_count(t->ranks),
                   mine = (count + ranks - 1 - rank) / ranks;
    struct watched_loop loop = {.watch = watch, .all = mine};
    struct sums sums = {0};
    const struct batches all = {tally, t, &sobol, from, to, rank, ranks, &loop, &sums};
    part_counts(tally, t->ranks);
    thread_pool_run(t->threads, mine, 1, trace_batches, &all);
    add_counts(tally, t->ranks, &sums);
    tally->rays += sums.rays;
    for (uint32_t k = 0; k < tally->bands; k++) /* of this call: all are alike but for chance */
        tally->square[k] = sums.first[k] > 0 ? (double)sums.second[k] / (double)sums.first[k] : 0;
    return loop.stopped ? -1 : 0;
}
