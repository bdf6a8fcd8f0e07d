/* surface_error.c - see surface_error.h.
 *
 * Points are drawn from several densities (error_places.h). What a point stands for is
 * 1 / sum_c n_c q_c over all of a stage, so a spot that none but the even one knows is found late,
 * but counted rightly. [Veach and Guibas 1995, section 3.3] The first stage only chooses: what it
 * found shapes the second's densities and how many rays a point takes, and is in no sum.
 *
 * Of every density's points two fall in each of its equal parts; their difference is the variance
 * of the part, and of any sum. Squares of errors are products of two independent halves
 * (point_error.h). All points of a half share its particles: how uncertain the light is that these
 * have counted in all is added, as if all that is reflected were off by it.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "engine/point_error.h"
#include "engine/surface_error.h"
#include "kernel/constants.h"
#include "util/ranks_loop.h"

/* Shares of the rays. Of the rest, 3 %, particles are made that show where light lands. */
#define SHARE_PARTICLES 0.32
#define SHARE_FIRST 0.15
#define SHARE_SECOND 0.50

/* STAGE_PAIRS: of points, of a density at the most, so that all are counted. */
enum { FIRST_COSINE = 8, FIRST_LIGHT = 4, STAGE_PAIRS = 1 << 28 };

static const double first_of[PLACES] = {0.3, 0.3, 0.4, 0},
                    second_of[PLACES] = {0.15, 0.2, 0.25, 0.4};

struct point {
    struct place place;
    double part; /* share of the line that it stands for; 0: covered */
    struct point_sample at;
};

struct stage {
    struct point *point;
    uint32_t count;            /* of all densities together */
    uint32_t from[PLACES + 1]; /* of each density's; they come in twos, both of one part */
    struct path_rays rays;     /* of one half of a point */
};

struct measurement {
    const struct tracer *tracer;
    struct point_error error;
    struct error_places places;
    uint64_t stream, rays;
    const struct watch *watch;
    double done, next; /* shares of the work */
};

/* ---- progress, and random numbers of each part of the work */

static int tell_part(void *context, double share)
{
    const struct measurement *m = context;
    return m->watch->tell(m->watch->context, m->done + (m->next - m->done) * share);
}

static void begin(struct measurement *m, double share)
{
    m->done = m->next;
    m->next += share;
}

static uint64_t stream_of(const struct measurement *m, uint64_t part)
{
    return hash64((m->stream * 8 + part + 1) * HASH_STEP) >> 16;
}

/* ---- points */

static double stands_for(const struct measurement *m, const struct stage *stage,
                         const struct place *at)
{
    double density = 0;
    for (int c = 0; c < PLACES; c++)
        if (stage->from[c + 1] > stage->from[c])
            density += (stage->from[c + 1] - stage->from[c])
                       * error_places_density(&m->places, (enum error_place)c, at);
    return 1 / density;
}

static void measure_point(const struct measurement *m, struct stage *stage, uint32_t i,
                          uint64_t stream, uint64_t *rays)
{
    struct point *point = &stage->point[i];
    int c = 0;
    while (i >= stage->from[c + 1])
        c++;
    struct dice dice = dice_of(stream, i);
    double parts = (stage->from[c + 1] - stage->from[c]) / 2,
           v = ((i - stage->from[c]) / 2 + dice_throw(&dice)) / parts;
    memset(point, 0, sizeof *point);
    point->place = error_places_draw(&m->places, (enum error_place)c, fmin(v, 1 - 0x1p-53), &dice);
    if (!point_error_measure(&m->error, &point->place, &stage->rays, &dice, &point->at, rays))
        point->part = stands_for(m, stage, &point->place);
}

/* The points of a stage. */
struct stage_points {
    const struct measurement *measurement;
    struct stage *stage;
    uint64_t stream;
    struct watched_loop *loop;
    _Atomic uint64_t *rays;
};

static void measure_points(const void *points, size_t from, size_t to)
{
    const struct stage_points *p = points;
    uint64_t rays = 0;
    for (uint32_t i = (uint32_t)from; i < to; i++) {
        if (watched_loop_stopped(p->loop))
            continue;
        measure_point(p->measurement, p->stage, i, p->stream, &rays);
        watched_loop_tell(p->loop);
    }
    *p->rays += rays;
}

/* Measure `n` points, of each density its share. Returns 0, or -1 when out of memory or stopped;
 * the points are the caller's in any case. */
static int measure_stage(struct measurement *m, struct stage *stage, double n,
                         const double share[PLACES], uint64_t stream)
{
    for (int c = 0; c < PLACES; c++)
        stage->from[c + 1] =
            stage->from[c] + 2 * (uint32_t)fmin(ceil(n * share[c] / 2), STAGE_PAIRS);
    stage->count = stage->from[PLACES];
    stage->point = malloc(stage->count * sizeof *stage->point);
    if (ranks_any(m->tracer->ranks, !stage->point))
        return -1;
    _Atomic uint64_t rays = 0;
    const struct watch part = {tell_part, m};
    struct watched_loop loop = {.watch = m->watch ? &part : NULL, .all = stage->count};
    const struct stage_points points = {m, stage, stream, &loop, &rays};
    ranks_loop_run(m->tracer->ranks, RANKS_PARTICLES, m->tracer->threads, stage->count, 16,
                   measure_points, &points, stage->point, sizeof *stage->point);
    uint64_t cast = rays;
    ranks_add_counts(m->tracer->ranks, RANKS_PARTICLES, &cast, 1);
    m->rays += cast;
    return loop.stopped ? -1 : 0;
}

static double product(const struct measurement *m, const struct point *p)
{
    double sum = 0;
    for (uint32_t k = 0; k < m->tracer->bands; k++)
        sum += p->at.error[0][k] * p->at.error[1][k];
    return sum;
}

static int by_line(const void *a, const void *b)
{
    const struct point *x = a, *y = b;
    return (x->place.u > y->place.u) - (x->place.u < y->place.u);
}

/* From what the first stage found: where error is. Sorts its points. Each neighbour counts, for a
 * single product is noisy. */
static int find_wrong(struct measurement *m, struct stage *stage)
{
    uint32_t n = stage->count;
    struct point *point = stage->point;
    double *place = malloc(n * sizeof *place), *weight = malloc(n * sizeof *weight);
    int failed = !place || !weight;
    qsort(point, n, sizeof *point, by_line);
    for (uint32_t i = 0; i < n && !failed; i++) {
        uint32_t from = i > 0 ? i - 1 : i, to = i + 1 < n ? i + 1 : i;
        place[i] = point[i].place.u;
        weight[i] = 0;
        for (uint32_t j = from; j <= to; j++)
            weight[i] += fabs(product(m, &point[j])) / (to - from + 1);
    }
    failed = failed || spread_around(&m->places.wrong, place, weight, n, 1) < 0;
    free(place);
    free(weight);
    return ranks_any(m->tracer->ranks, failed) ? -1 : 0;
}

/* By what factor more rays of a point make the mean square surest at the same cost. Its variance is
 * (S + A / g^2) g / rays: S that of squares among points, A that of the noise of one product. */
static double rays_pay(const struct measurement *m, const struct stage *stage)
{
    double all = 0, noise = 0, most = SURFACE_ERROR_RAYS;
    for (uint32_t i = 0; i < stage->count; i++) {
        const struct point *p = &stage->point[i];
        double ab = product(m, p), square = 0;
        for (uint32_t k = 0; k < m->tracer->bands; k++) {
            double off = p->at.error[0][k] - p->at.error[1][k];
            square += 0.5 * off * off;
        }
        all += p->part * p->part * ab * ab;
        noise += p->part * p->part * square * square / 3; /* of a normal: E x^4 = 3 (E x^2)^2 */
    }
    return noise > 0 ? fmax(sqrt(noise / fmax(all - noise, noise / (most * most))), 1) : 1;
}

/* ---- the mean square */

static double both_reflect(const struct measurement *m, const struct point *p)
{
    double sum = 0;
    for (uint32_t k = 0; k < m->tracer->bands; k++)
        sum += (p->at.solved[k] - p->at.error[0][k]) * (p->at.solved[k] - p->at.error[1][k]);
    return sum;
}

/* How far an interval reaches below and above a sum z[0] + .. Student's quantile by as many parts
 * as would know the variance as well, were all alike [Cornish and Fisher 1937]; and, for a few
 * large terms make the sum too small more often than too large, what skewness shifts [Hall 1992,
 * On the removal of skewness by transformation]. common: variance that all terms share. */
static void interval(const struct stage *stage, const double *z, double common, double *below,
                     double *above)
{
    double sum = 0, square = 0, cube = 0;
    for (uint32_t i = 0; i + 1 < stage->count; i += 2) {
        double d = (z[i] - z[i + 1]) * (z[i] - z[i + 1]);
        sum += d;
        square += d * d;
        cube += z[i] * z[i] * z[i] + z[i + 1] * z[i + 1] * z[i + 1];
    }
    double all = sum + common, se = sqrt(all),
           freedom = square > 0 ? fmax(3 * all * all / square, 2) : INFINITY,
           reach = NORMAL_T * (1 + (NORMAL_T * NORMAL_T + 1) / (4 * freedom)),
           skewness = all > 0 ? fmin(fmax(cube / (all * se), 0), 1) : 0,
           shift = skewness * (2 * NORMAL_T * NORMAL_T + 1) / 6;
    *below = reach * se; /* not less: skewness is known by a few terms alone */
    *above = (reach + shift) * se;
}

static struct RadMeasure mean_square(const struct measurement *m, const struct stage *stage,
                                     double *z)
{
    double error = 0, light = 0, both = 0, below, above;
    for (uint32_t i = 0; i < stage->count; i++) {
        const struct point *p = &stage->point[i];
        error += p->part * product(m, p);
        light += p->part * both_reflect(m, p);
        for (uint32_t k = 0; k < m->tracer->bands; k++) {
            double e = 0.5 * (p->at.error[0][k] + p->at.error[1][k]);
            both += p->part * e * (p->at.solved[k] - e);
        }
    }
    if (!(light > 0))
        return (struct RadMeasure){0, 0, 0};
    double ratio = error / light;
    for (uint32_t i = 0; i < stage->count; i++)
        z[i] = stage->point[i].part
               * (product(m, &stage->point[i]) - ratio * both_reflect(m, &stage->point[i])) / light;
    double common = both / light;
    common *= common * HALVES * m->error.variance;
    interval(stage, z, common, &below, &above);
    /* No square is below 0: an estimate that noise has brought there says no more than 0 would. */
    ratio = fmax(ratio, 0);
    return (struct RadMeasure){sqrt(ratio), sqrt(fmax(ratio - below, 0)), sqrt(ratio + above)};
}

/* ---- all of it */

static int measure_all(struct measurement *m, const struct solve *s,
                       const struct element_light *light, double rays, struct stage stage[2],
                       struct surface_error *out)
{
    struct watch watch = {tell_part, m};
    begin(m, SHARE_PARTICLES);
    if (point_error_open(&m->error, s, m->tracer, light, (uint64_t)(SHARE_PARTICLES * rays),
                         stream_of(m, 0), m->watch ? &watch : NULL, &m->rays)
        < 0)
        return -1;
    double each = HALVES * (FIRST_COSINE + FIRST_LIGHT);
    stage[0].rays = (struct path_rays){FIRST_COSINE, FIRST_LIGHT};
    begin(m, SHARE_FIRST);
    if (measure_stage(m, &stage[0], SHARE_FIRST * rays / each, first_of, stream_of(m, 2)) < 0
        || find_wrong(m, &stage[0]) < 0)
        return -1;
    double more = ceil(2 * rays_pay(m, &stage[0])) / 2;
    stage[1].rays = (struct path_rays){FIRST_COSINE * more, FIRST_LIGHT * more};
    begin(m, 1 - m->next);
    if (measure_stage(m, &stage[1], SHARE_SECOND * rays / (each * more), second_of, stream_of(m, 3))
        < 0)
        return -1;
    double *z = malloc(stage[1].count * sizeof *z);
    if (ranks_any(m->tracer->ranks, !z)) {
        free(z);
        return -1;
    }
    out->l2 = mean_square(m, &stage[1], z);
    free(z);
    out->rays = m->rays;
    return 0;
}

int surface_error_measure(const struct solve *s, const struct tracer *t,
                          const struct element_light *light, uint64_t rays, uint64_t stream,
                          const struct watch *watch, struct surface_error *out)
{
    struct measurement m = {.tracer = t, .watch = watch, .stream = stream};
    struct stage stage[2] = {{0}, {0}};
    double all = fmax((double)rays, SURFACE_ERROR_LEAST),
           landings = (1 - SHARE_PARTICLES - SHARE_FIRST - SHARE_SECOND) * all;
    *out = (struct surface_error){0};
    int failed = error_places_open(&m.places, t, light, (uint32_t)fmin(landings, 0x1p30),
                                   stream_of(&m, 1), &m.rays);
    failed = ranks_any(t->ranks, failed) ? -1 : 0;
    if (!failed && m.places.line.count > 0 && t->lights.count > 0)
        failed = measure_all(&m, s, light, all, stage, out);
    for (int i = 0; i < 2; i++)
        free(stage[i].point);
    error_places_close(&m.places);
    point_error_close(&m.error);
    return failed;
}
