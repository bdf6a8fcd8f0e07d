/* tail_error.c - see tail_error.h.
 *
 * Points are spread evenly over the area, one by chance in each of POINTS equal parts. At each the
 * true radiosity is found by whole paths (paths.h), which are free of bias. Few paths at all points
 * tell which CANDIDATES have the largest errors; those are measured anew, by many paths of other
 * random numbers, for the largest of noisy numbers are large by their noise.
 *
 * The quantile and its interval are order statistics: of n points X are beyond it, X binomial with
 * n and 1/1000, and for n = 4096 it is 1 to 8 with a probability of 96.3 %; so the quantile is
 * between the largest error and the ninth. Their own noise widens it.
 * [order statistics as limits of a quantile: Thompson 1936]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "engine/tail_error.h"
#include "kernel/leaf_at.h"
#include "particles/area_line.h"
#include "particles/paths.h"
#include "util/ranks_loop.h"
#include "visibility/contact_fraction.h"

enum { POINTS = 4096, CANDIDATES = 48, TAIL = POINTS / 1000, BEYOND = 8, PATHS_MOST = 4096 };

/* of the rays: for all points; the rest is for candidates */
#define SHARE_ALL 0.6

struct point {
    double p[3]; /* just in front of the face (m) */
    uint32_t face;
    uint32_t leaf; /* UINT32_MAX: a solid covers the point */
    uint32_t index;
    double error;     /* sum over bands of |e| (W/m2) */
    double deviation; /* its standard error */
};

struct tail {
    const struct solve *solve;
    const struct tracer *tracer;
    const struct element_light *light;
    uint64_t stream;
};

/* Measure a point by so many paths. Returns the rays cast. */
static uint64_t measure_point(const struct tail *x, struct point *point, uint64_t stage,
                              uint32_t paths)
{
    const struct problem *p = &x->solve->problem;
    struct dice dice = dice_of(x->stream * 4 + stage, point->index);
    double sum[3] = {0, 0, 0}, squares = 0;
    uint64_t rays = 0;
    const double *rho = &p->reflectance[(size_t)point->face * p->bands];
    for (uint32_t i = 0; i < paths; i++) {
        double h[3] = {0, 0, 0}, all = 0;
        path_irradiance(x->tracer, point->face, point->p, &dice, h, &rays);
        for (uint32_t k = 0; k < p->bands; k++) {
            sum[k] += h[k];
            all += rho[k] * h[k];
        }
        squares += all * all;
    }
    double error = 0, mean = 0;
    for (uint32_t k = 0; k < p->bands; k++) {
        double reflected = element_light_at(x->light, point->leaf, k, point->p)
                           - p->exitance[(size_t)point->face * p->bands + k];
        error += fabs(reflected - rho[k] * sum[k] / paths);
        mean += rho[k] * sum[k] / paths;
    }
    point->error = error;
    point->deviation =
        paths > 1 ? sqrt(fmax(0, squares / paths - mean * mean) / (paths - 1)) : INFINITY;
    return rays;
}

struct stage_points {
    const struct tail *tail;
    struct point *points;
    uint64_t stage;
    uint32_t paths;
    struct watched_loop *loop;
    _Atomic uint64_t *rays;
};

static void measure_some(const void *points, size_t from, size_t to)
{
    const struct stage_points *p = points;
    for (size_t i = from; i < to; i++) {
        if (watched_loop_stopped(p->loop))
            continue;
        if (p->points[i].leaf != UINT32_MAX)
            *p->rays += measure_point(p->tail, &p->points[i], p->stage, p->paths);
        watched_loop_tell(p->loop);
    }
}

/* Measure points of a stage. Returns the rays cast, or UINT64_MAX when stopped. */
static uint64_t measure_points(const struct tail *x, struct point *points, uint32_t count,
                               uint64_t stage, uint32_t paths, const struct watch *watch)
{
    _Atomic uint64_t rays = 0;
    struct watched_loop loop = {.watch = watch, .all = count};
    const struct stage_points all = {x, points, stage, paths, &loop, &rays};
    ranks_loop_run(x->tracer->ranks, RANKS_PARTICLES, x->tracer->threads, count, 16, measure_some,
                   &all, points, sizeof *points);
    uint64_t cast = rays;
    ranks_add_counts(x->tracer->ranks, RANKS_PARTICLES, &cast, 1);
    return loop.stopped ? UINT64_MAX : cast;
}

/* Lay points over the area. Returns the mean of the light that the solution reflects there, all
 * bands (W/m2). */
static double lay_points(const struct tail *x, const struct area_line *line, struct point *points)
{
    const struct hierarchy *h = &x->solve->hierarchy;
    const struct problem *p = &x->solve->problem;
    double mean = 0, weight[4];
    uint32_t bare = 0;
    for (uint32_t i = 0; i < POINTS; i++) {
        struct point *at = &points[i];
        struct dice dice = dice_of(x->stream * 4 + 2, i);
        *at = (struct point){.index = i, .leaf = UINT32_MAX};
        at->face =
            area_line_point(line, x->tracer, (i + dice_throw(&dice)) * (1.0 / POINTS), at->p);
        uint32_t leaf = leaf_at(h->elements, h->face_element[at->face], at->p, weight);
        if (contact_covers(p->rays, tracer_surface(x->tracer, at->face), at->p))
            continue;
        at->leaf = leaf;
        bare++;
        for (uint32_t k = 0; k < p->bands; k++)
            mean += element_light_at(x->light, leaf, k, at->p)
                    - p->exitance[(size_t)at->face * p->bands + k];
    }
    return bare ? mean / bare : 0;
}

static int by_error(const void *a, const void *b)
{
    const struct point *x = a, *y = b;
    if (x->error != y->error)
        return x->error < y->error ? 1 : -1;
    return (x->index > y->index) - (x->index < y->index);
}

static uint32_t paths_for(double rays, double each)
{
    double paths = each > 0 ? rays / each : 1;
    return paths < 1 ? 1 : paths > PATHS_MOST ? PATHS_MOST : (uint32_t)paths;
}

int tail_error_measure(const struct solve *s, const struct tracer *t,
                       const struct element_light *light, uint64_t budget, uint64_t stream,
                       const struct watch *watch, struct RadMeasure *tail, uint64_t *rays)
{
    const struct tail x = {s, t, light, stream};
    struct area_line line;
    *tail = (struct RadMeasure){0, 0, 0};
    if (t->lights.count == 0)
        return 0;
    if (area_line_open(&line, t) < 0)
        return -1;
    struct point *points = calloc(POINTS, sizeof *points);
    int result = points ? 0 : -1;
    if (result == 0 && line.count > 0) {
        double mean = lay_points(&x, &line, points);
        uint64_t once = measure_points(&x, points, POINTS, 0, 1, watch), more = 0, last = 0;
        if (once != UINT64_MAX)
            more = measure_points(&x, points, POINTS, 1,
                                  paths_for(SHARE_ALL * (double)budget, (double)once), watch);
        qsort(points, POINTS, sizeof *points, by_error);
        if (once != UINT64_MAX && more != UINT64_MAX)
            last = measure_points(
                &x, points, CANDIDATES, 3,
                paths_for((1 - SHARE_ALL) * (double)budget, (double)once * CANDIDATES / POINTS),
                watch);
        qsort(points, CANDIDATES, sizeof *points, by_error);
        result = once == UINT64_MAX || more == UINT64_MAX || last == UINT64_MAX ? -1 : 0;
        *rays += result == 0 ? once + more + last : 0;
        if (result == 0 && mean > 0)
            *tail = (struct RadMeasure){points[TAIL].error / mean,
                                        fmax(0, points[BEYOND].error - 2 * points[BEYOND].deviation)
                                            / mean,
                                        (points[0].error + 2 * points[0].deviation) / mean};
    }
    free(points);
    area_line_close(&line);
    return result;
}
