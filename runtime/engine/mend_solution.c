/* mend_solution.c - see mend_solution.h.
 *
 * Particles come by doubling, so that how many there are follows from counts alone and never from
 * the clock: the same solution and the same error for any number of threads.
 * SPDX-License-Identifier: MIT */
#include "engine/mend_solution.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/covered_leaves.h"
#include "engine/detail.h"
#include "engine/dim_faces.h"
#include "engine/mend.h"
#include "engine/mended_error.h"
#include "engine/own_quarters.h"
#include "engine/path_mending.h"
#include "engine/ray_split.h"
#include "engine/solve_tracer.h"
#include "engine/trace_rays.h"
#include "engine/ambient.h"
#include "kernel/constants.h"
#include "util/clock.h"
#include "util/thread_pool.h"
/* rays of a look by particles where the goal says nothing of it */
enum { LOOK = 1 << 15 };

/* Slopes of linear elements go with what is reflected, so that none is below 0 at a corner. */
static void mend_gradients(const void *solve, size_t from, size_t to)
{
    const struct solve *s = solve;
    const struct problem *p = &s->problem;
    for (size_t i = from; i < to; i++) {
        const struct element *e = &s->hierarchy.elements[i / p->bands];
        if (!e->vertices)
            continue;
        double exitance = p->exitance[(size_t)e->face * p->bands + i % p->bands];
        double linked = s->state.radiosity[i] - exitance;
        double ratio = linked > 0 ? (s->mended.radiosity[i] - exitance) / linked : 0;
        for (size_t c = 0; c < 3; c++)
            s->mended_gradient[3 * i + c] = s->linear.gradient[3 * i + c] * ratio;
    }
}

/* What goes with the irradiances of the mended solution. Returns 0, or -1 when out of memory. */
static int follow_irradiance(struct solve *s)
{
    const size_t values = (size_t)s->hierarchy.count * s->problem.bands;
    const int threads = s->problem.options.threads, sloped = s->linear.gradient != NULL;
    light_follows(s, &s->mended);
    if (own_quarters(s)) { /* what is made of quarters owners know, and then clusters follow */
        if (own_quarters_tell(s, s->mended.radiosity, s->problem.bands) < 0)
            return -1;
        light_of_clusters_follows(s, &s->mended);
    }
    if (sloped && !s->mended_gradient)
        s->mended_gradient = calloc(3 * values, sizeof *s->mended_gradient);
    if (ranks_any(s->problem.options.ranks, sloped && !s->mended_gradient))
        return -1;
    if (sloped)
        thread_pool_run(threads, values, 1024, mend_gradients, s);
    return 0;
}

/* Polygons of a size, and what goes with them. Returns 0, or -1 when out of memory or cancelled. */
static int mend_polygons(struct solve *s, const struct tracer *t, const struct tally *tally,
                         enum dim_size size, const struct dim_budget *budget,
                         const struct watch *watch, uint64_t *spent, struct dim_count *count,
                         double band_noise[3])
{
    const int changed = dim_faces_mend(s, t, tally, size, budget, watch, spent, count, band_noise);
    return changed > 0 ? follow_irradiance(s) : changed;
}

/* So many rays for paths, and as many again where that makes some surer. */
static struct dim_budget twice(double paths)
{
    return (struct dim_budget){.paths = paths, .surer = 2 * paths};
}

/* Dim polygons, by as many rays as mending would have taken without links (unaided), and what links
 * have spared of these, if large ones want it, but for what is left of goal->most, or as many as
 * mending took; they are added to *spent. Returns 0, or -1 when out of memory or cancelled.
 */
static int mend_dim(struct solve *s, const struct tracer *t, const struct tally *tally,
                    const struct mending_goal *goal, double unaided, struct measured_error *alone,
                    uint64_t *spent)
{
    const double mending = (double)tally->rays, spared = fmax(unaided - mending, 0),
                 most = fmax((double)goal->most - mending - (double)*spent, mending),
                 paths = fmin(DIM_RAYS * (mending + spared) + spared, most),
                 both = fmax(DIM_FEW - (double)s->report.counts.rays - mending, 0);
    const struct dim_budget large = {paths, fmin(2 * paths, most), both};
    const double budget = fmax(paths, both);
    struct watched_rays watched = {.solve = s,
                                   .before = tally->rays + *spent,
                                   .now = budget,
                                   .all = (double)(tally->rays + *spent) + budget};
    const struct watch watch = {watched_rays_tell, &watched};
    struct dim_count groups;
    if (mend_polygons(s, t, tally, DIM_LARGE_ONES, &large, &watch, spent, &alone->dim,
                      alone->faces.band_noise)
        < 0)
        return -1;
    /* Of groups it is told in any case which are not known. */
    const uint64_t before = *spent;
    const double left = fmin(fmax(DIM_RAYS * mending, DIM_SMALL), both - (double)before);
    const struct dim_budget gathered = twice(DIM_GATHERED * fmax(fmin(left, mending), 0));
    if (mend_polygons(s, t, tally, DIM_GROUPS, &gathered, &watch, spent, &groups,
                      alone->faces.band_noise)
        < 0)
        return -1;
    alone->gathered = groups.large;
    dim_count_add(&alone->dim, &groups);
    const struct dim_budget rest = twice(fmax(left - (double)(*spent - before), 0));
    return mend_polygons(s, t, tally, DIM_SMALL_ONES, &rest, &watch, spent, &alone->small,
                         alone->faces.band_noise);
}

static int mend_by(struct solve *s, const struct tally *tally, double *irradiance)
{
    return mend_irradiance(&s->operator, tally, irradiance) < 0
                   || own_quarters_tell(s, irradiance, s->problem.bands) < 0
               ? -1
               : 0;
}

/* What goes with them, once nobody asks for what leaves have been counted on. */
static int follow_counted(struct solve *s, struct tally *tally)
{
    tally_forget_leaves(tally);
    return follow_irradiance(s);
}

/* By what particles counted, and then by paths, if there are any. */
static int mend(struct solve *s, const struct tracer *t, struct tally *tally,
                const struct tally *paths, const struct mending_goal *goal, double unaided,
                struct measured_error *alone, uint64_t *spent)
{
    tally_add(tally, t->ranks);
    size_t values = (size_t)s->hierarchy.count * s->problem.bands;
    struct state *m = &s->mended;
    struct mended_reach reach;
    solve_forget_mended(s);
    if (mended_reach_find(s, paths ? paths : tally, &reach) < 0)
        return -1;
    m->radiosity = malloc(values * sizeof *m->radiosity);
    m->irradiance = malloc(values * sizeof *m->irradiance);
    if (!ranks_any(s->problem.options.ranks, !m->radiosity || !m->irradiance)) {
        memcpy(m->irradiance, s->state.irradiance, values * sizeof *m->irradiance);
        if (mend_by(s, tally, m->irradiance) == 0
            && (!paths || mend_by(s, paths, m->irradiance) == 0) && follow_counted(s, tally) == 0
            && (goal->look
                || mend_dim(s, t, paths ? paths : tally, goal, unaided, alone, spent) == 0)) {
            s->reach = reach;
            return 0;
        }
    }
    solve_forget_mended(s);
    return -1;
}

/* mended_error_times, of what all ranks have counted. */
static int times_wanted(struct solve *s, struct tally *tally, const struct mending_goal *goal,
                        double *times, double *alone)
{
    tally_add_faces(tally, s->problem.options.ranks);
    return mended_error_times(s, tally, goal, times, alone);
}

/* Trace until links and particles together are as near on places as is wanted, by what the
 * particles tell so far. These double at the most before that is asked again. Returns 0, or -1 when
 * cancelled or out of memory. */
static int trace_for_places(struct solve *s, const struct tracer *t, struct tally *tally,
                            const struct mending_goal *goal)
{
    double wanted = (double)goal->least;
    do {
        double next = fmin(fmin(wanted, fmax(2.0 * (double)tally->rays, (double)goal->least)),
                           (double)goal->most);
        struct ray_split split;
        if (((double)tally->rays < 0.99 * next
             && trace_rays(s, t, tally, (uint64_t)next, fmin(wanted, (double)goal->most)) < 0)
            || ray_split_measure(&s->operator, tally, s->state.irradiance, &split) < 0)
            return -1;
        wanted = ray_split_wanted(&split, goal->places);
    } while (tally->rays > 0 && (double)tally->rays < 0.99 * fmin(wanted, (double)goal->most));
    return 0;
}

/* The same until the L1 error of polygons is small enough. *unaided: rays that this would take
 * without links, about. */
static int trace_for_faces(struct solve *s, const struct tracer *t, struct tally *tally,
                           const struct mending_goal *goal, double *unaided)
{
    double times = t->lights.power > 0 ? INFINITY : 0, alone = 1;
    if (tally->particles > 0 && times > 0 && times_wanted(s, tally, goal, &times, &alone) < 0)
        return -1;
    while (times > 1 && tally->rays < goal->most) {
        /* they double at the most before that is asked again */
        const double now = (double)tally->rays, all = now * times,
                     growth = mended_error_growth(goal, now, 2),
                     next = fmin(fmin(1.02 * all, growth * now), (double)goal->most);
        uint64_t before = tally->rays;
        if (trace_rays(s, t, tally, next > 1 ? (uint64_t)next : 1, fmin(all, (double)goal->most))
                < 0
            || times_wanted(s, tally, goal, &times, &alone) < 0)
            return -1;
        if (tally->rays == before)
            break;
    }
    *unaided = fmin((double)tally->rays * alone, (double)goal->most);
    return 0;
}

/* How many are to land, about. */
static double landings(const struct mending_goal *goal)
{
    double expected = fmax(goal->expected, DETAIL_LANDINGS * (double)goal->least);
    return goal->places > 0 ? fmin(expected, (double)goal->most) : (double)goal->most;
}

/* Leaves are made for no more than so many. What n tell of a leaf is off by 1 / sqrt(n): where
 * links are off by e it takes 1 / e^2 to say anything. What is known is the mean over all places,
 * and some are off by far more; but it is of coarser links. So cells of cornell, room, maze_8 and
 * panels are as near without these quarters, and those of corridor and gridroom_1000, which keep
 * the coarse links, farther off by a tenth. A look tells of polygons alone. */
static double landings_that_tell(const struct mending_goal *goal)
{
    const double share = goal->linked > 0 ? fmin(MEND_DETAIL * goal->linked, 1) : 1;
    return goal->look ? 0 : share * landings(goal);
}

/* Without links nobody knows where leaves should be small. So before any that count a few particles
 * are traced, then eight times as many and so on, as long as all of them are a small part of the
 * rays to come: each look sets the light of leaves, which the next ones are made by, and says how
 * far off that is. Their rays are added to *spent; goal->expected becomes what is left to do.
 * Returns 0, or -1 when cancelled or out of memory. */
static int look_ahead(struct solve *s, const struct tracer *t, struct mending_goal *goal,
                      uint64_t *spent)
{
    enum { STREAM = 0x6c6f6f6b, SMALL = 16, MORE = 8 };
    uint64_t stream = STREAM;
    for (double rays = LOOK; rays * SMALL <= landings(goal); rays *= MORE, stream++) {
        struct tally tally = {0};
        struct ray_split split;
        int failed = detail_leaves(s, rays) < 0 || tally_open(&tally, t, stream, 1) < 0
                     || trace_rays(s, t, &tally, (uint64_t)rays, landings(goal)) < 0
                     || ray_split_measure(&s->operator, & tally, s->state.irradiance, &split) < 0;
        if (!failed)
            tally_add(&tally, t->ranks);
        failed = failed || mend_by(s, &tally, s->state.irradiance) < 0 || own_quarters_share(s) < 0;
        *spent += tally.rays;
        tally_close(&tally);
        if (failed)
            return -1;
        if (split.links > 0 && split.ray > 0)
            split.links = 1 / (1 / split.links + (double)split.rays / split.ray);
        goal->expected = ray_split_wanted(&split, goal->places);
        light_follows(s, &s->state);
    }
    return 0;
}

/* A first look by particles; then paths, if they are much cheaper for polygons: s->by_paths.
 * Returns 0, or -1 when cancelled or out of memory. */
static int look_first(struct solve *s, const struct tracer *t, struct tally *tally,
                      struct path_tally *paths, const struct mending_goal *goal)
{
    const uint64_t first = goal->least > 0 ? goal->least : LOOK,
                   rays = first < goal->most ? first : goal->most;
    if (trace_rays(s, t, tally, rays, (double)goal->most) < 0)
        return -1;
    struct watched_rays watched = {.solve = s, .before = tally->rays, .all = (double)goal->most};
    watched.now = fmax(watched.all - (double)tally->rays, 0);
    const struct watch watch = {watched_rays_tell, &watched};
    if (tally->rays == 0)
        return 0;
    tally_add_faces(tally, t->ranks);
    s->by_paths = path_mending_trace(paths, s, t, tally, goal, &watch);
    if (s->by_paths == 0) { /* what they saw is forgotten, but for what it took */
        const uint64_t spent = paths->paths.rays;
        path_tally_close(paths);
        paths->paths.rays = spent;
    }
    return s->by_paths < 0 ? -1 : 0;
}

int measure_and_mend(struct solve *s, const struct mending_goal *goal, struct measured_error *alone,
                     const char **cause)
{
    double start = seconds();
    struct tracer t = solve_tracer(s);
    struct tally tally = {0};
    struct path_tally paths = {.tally = {0}};
    struct mending_goal left = *goal;
    uint64_t spent = 0;
    double unaided = 0;
    s->told = 0;
    *alone = (struct measured_error){0};
    solve_forget_mended(s);
    s->by_paths = 0;
    int failed = own_quarters_share(s) < 0 || tracer_open(&t) < 0
                 || (s->problem.options.no_links && look_ahead(s, &t, &left, &spent) < 0)
                 || covered_leaves(s) < 0;
    const uint32_t elements = s->hierarchy.count;
    failed = failed || detail_leaves(s, landings_that_tell(&left)) < 0
             || tally_open(&tally, &t, MEND_STREAM, 1) < 0
             || look_first(s, &t, &tally, &paths, goal) < 0
             || (!s->by_paths && goal->places > 0 && trace_for_places(s, &t, &tally, goal) < 0)
             || (!s->by_paths && trace_for_faces(s, &t, &tally, goal, &unaided) < 0)
             || measured_faces(s, s->by_paths ? &paths.tally : &tally, alone) < 0;
    s->report.particles = 0;
    if (!failed) { /* while faces are dealt out as they were */
        tally_add(&tally, t.ranks);
        s->report.particles = tally_fingerprint(&tally, t.ranks)
                              + (s->by_paths ? tally_fingerprint(&paths.tally, t.ranks) : 0);
    }
    failed =
        failed
        || mend(s, &t, &tally, s->by_paths ? &paths.tally : NULL, goal, unaided, alone, &spent) < 0
        || detail_merge(s, elements) < 0 || (!goal->own && own_quarters_share(s) < 0);
    if (failed)
        s->report.particles = 0;
    alone->rays = tally.rays + paths.paths.rays;
    path_tally_close(&paths);
    tally_close(&tally);
    tracer_close(&t);
    if (failed) {
        s->by_paths = 0;
        measured_error_free(alone);
        return trace_rays_failed(s, cause);
    }
    solve_sum_power(s);
    alone->rays += spent;
    alone->seconds = seconds() - start;
    return 0;
}
