/* dim_paths.c - see dim_paths.h.
 *
 * A path looks for emitters from its first two points, both ways (paths.h), and then asks the
 * mended solution B~ what leaves the third, if that is farther off than the element there is large
 * and as much light falls there as particles know; else it goes on. One reflection less and the
 * mean of an element that is lit in part would stand for its dark part behind the edge: on a
 * cupboard's back, a hand's breadth before a wall, sixteen times the light. And a floor that is
 * known as a whole may lie in the dark beyond a door, where nobody knows it: in maze_8 two walls
 * there were 8 % too bright, in the mean over ten orders of its faces. So the mean of paths is not
 * free of bias: it has B~'s error at second and later points, in the mean over all that the polygon
 * sees. [final gathering: Reichert 1992; Jensen 2001, section 9.3, for what is near]
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include "engine/dim_paths.h"
#include "particles/paths.h"
#include "particles/running_sums.h"
#include "util/ranks_loop.h"

/* Random numbers that nothing else takes; each polygon has its own. */
static const uint64_t STREAM = (uint64_t)0x64696d << 32;

/* Where a path has come to from `from`: adds what leaves that point to h[bands], if the solution
 * may be asked for it. */
static int ask_solution(const struct dim_faces *d, const struct path *p, const double from[3],
                        double *h)
{
    const struct tracer *t = d->tracer;
    double away[3];
    if (d->of[d->part[p->face]] != NOT_DIM)
        return 0;
    const struct leaf_light leaf = quarter_light_at(&d->light, p->face, p->at);
    sub3(away, p->at, from);
    if (!(dot3(away, away) > leaf.area && leaf.irradiance >= d->believed))
        return 0;
    for (uint32_t k = 0; k < t->bands; k++)
        h[k] += p->through[k] * (leaf.radiosity[k] - t->exitance[(size_t)p->face * t->bands + k]);
    return 1;
}

/* What one path from x, just in front of the face, finds: h[bands], 0 before. *sighted is raised
 * where it meets a front. */
static void trace_path(const struct dim_faces *d, uint32_t face, const double x[3],
                       struct dice *dice, double *h, uint64_t *rays, uint64_t *sighted)
{
    struct path p = path_from(face, x);
    for (int met_before = 0;; met_before++) {
        const double from[3] = {p.x[0], p.x[1], p.x[2]};
        if (!path_step(d->tracer, &p, dice, h, rays))
            return;
        *sighted += met_before == 0;
        if (met_before > 0 && ask_solution(d, &p, from, h))
            return;
        /* At first it goes on for certain: two points are what a path is for. */
        if (!path_reflect(d->tracer, &p, met_before > 0 ? dice : NULL))
            return;
    }
}

/* DIM_BLOCK paths of a polygon, from number `first` on. */
struct block {
    uint32_t polygon;
    uint64_t first, rays, sighted;
    double sum[3], all, square;
};

static void trace_block(const struct dim_faces *d, struct block *b)
{
    const struct tracer *t = d->tracer;
    const struct dim_polygon *p = &d->polygon[b->polygon];
    const double *until = &d->until[p->from];
    const uint64_t stream = STREAM + d->face[p->from];
    uint32_t shift[SOBOL_COORDINATES];
    sobol_sequence_shifts(stream, shift);
    for (uint64_t i = b->first; i < b->first + DIM_BLOCK; i++) {
        struct dice dice = dice_of_point(t, stream, i, shift, i);
        double w = dice_throw(&dice), u = dice_throw(&dice), v = dice_throw(&dice);
        double x[3], h[3] = {0, 0, 0}, all = 0;
        uint32_t face = d->face[p->from + running_sums_find(until, p->to - p->from, w * p->area)];
        tracer_point(t, face, u, v, x);
        trace_path(d, face, x, &dice, h, &b->rays, &b->sighted);
        for (uint32_t k = 0; k < t->bands; k++) {
            b->sum[k] += h[k];
            all += t->reflectance[(size_t)face * t->bands + k] * h[k];
        }
        b->all += all;
        b->square += all * all;
    }
}

struct blocks {
    const struct dim_faces *d;
    struct block *block;
    struct watched_loop *loop;
};

static void trace_blocks(const void *blocks, size_t from, size_t to)
{
    const struct blocks *b = blocks;
    for (size_t i = from; i < to; i++) {
        if (watched_loop_stopped(b->loop))
            continue;
        trace_block(b->d, &b->block[i]);
        watched_loop_tell(b->loop);
    }
}

int dim_paths_trace(struct dim_faces *d)
{
    size_t count = 0, next = 0;
    for (uint32_t j = 0; j < d->count; j++)
        if (d->polygon[j].wanted > d->polygon[j].paths)
            count += (d->polygon[j].wanted - d->polygon[j].paths + DIM_BLOCK - 1) / DIM_BLOCK;
    struct block *block = calloc(count + 1, sizeof *block);
    if (ranks_any(d->tracer->ranks, !block)) {
        free(block);
        return -1;
    }
    for (uint32_t j = 0; j < d->count; j++)
        for (struct dim_polygon *p = &d->polygon[j]; p->paths < p->wanted; p->paths += DIM_BLOCK)
            block[next++] = (struct block){.polygon = j, .first = p->paths};
    struct watched_loop loop = {.watch = d->watch, .all = count};
    const struct blocks all = {d, block, &loop};
    ranks_loop_run(d->tracer->ranks, RANKS_PARTICLES, d->tracer->threads, count, 1, trace_blocks,
                   &all, block, sizeof *block);
    for (size_t i = 0; i < count; i++) {
        struct dim_polygon *p = &d->polygon[block[i].polygon];
        p->rays += block[i].rays;
        *d->rays += block[i].rays;
        for (uint32_t k = 0; k < d->tracer->bands; k++)
            p->sum[k] += block[i].sum[k];
        p->sighted += block[i].sighted;
        p->all += block[i].all;
        p->square += block[i].square;
    }
    free(block);
    return loop.stopped ? -1 : 0;
}
