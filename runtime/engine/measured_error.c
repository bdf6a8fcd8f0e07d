/* measured_error.c - see measured_error.h.
 * SPDX-License-Identifier: MIT */
#include "engine/measured_error.h"
#include "engine/detail.h"
#include "engine/own_quarters.h"
#include "engine/path_mending.h"
#include "engine/solve_tracer.h"
#include "engine/surface_error.h"
#include "engine/tail_error.h"
#include "engine/trace_rays.h"
#include "util/clock.h"

int measured_faces(struct solve *s, struct tally *tally, struct measured_error *m)
{
    tally_add(tally, s->problem.options.ranks);
    m->rays = tally->rays;
    m->particles = tally->particles * REPLICATES;
    m->by_paths = tally->by_paths;
    if (black_backs_find(&m->backs, s->problem.scene, tally, s->problem.options.ranks) < 0)
        return -1;
    if (face_error_open(&m->faces, &s->problem, &s->hierarchy, solve_shown(s)->irradiance, tally)
        < 0)
        return -1;
    mended_reach_narrow(&s->reach, &m->faces);
    return 0;
}

int measured_elements(const struct solve *s, struct measured_error *m)
{
    if (m->elements.error || !m->tally.face || (!m->tally.element && !m->by_paths))
        return 0;
    if (element_error_open(&m->elements, &s->operator, & m->faces, &m->tally,
                           solve_shown(s)->irradiance)
        < 0)
        return -1;
    tally_close(&m->tally);
    return 0;
}

/* l2 and p999, by about so many rays each. Returns 0, or -1 when cancelled or out of memory. */
static int measure_surfaces(struct solve *s, const struct tracer *t, uint64_t rays, uint64_t stream,
                            struct measured_error *m)
{
    const struct element_light shown = element_light_shown(s);
    struct watched_rays watched = {.solve = s,
                                   .before = m->rays,
                                   .now = (double)rays,
                                   .all = (double)m->rays + 2 * (double)rays};
    const struct watch watch = {watched_rays_tell, &watched};
    struct surface_error surface;
    if (surface_error_measure(s, t, &shown, rays, stream, &watch, &surface) < 0)
        return -1;
    m->l2 = surface.l2;
    m->rays += surface.rays;
    watched.before = m->rays;
    return tail_error_measure(s, t, &shown, rays, stream, &watch, &m->p999, &m->rays);
}

/* Particles, or paths where these have mended, on polygons, and, if asked for, on leaves where all
 * have them; about so many rays of `all`. Returns 0, or -1 when cancelled or out of memory. */
static int count(struct solve *s, const struct tracer *t, uint64_t rays, double all,
                 uint64_t stream, int leaves, struct tally *tally)
{
    if (!s->by_paths)
        return tally_open(tally, t, stream, leaves && !own_quarters(s)) < 0
                       || trace_rays(s, t, tally, rays, all) < 0
                   ? -1
                   : 0;
    struct watched_rays watched = {.solve = s, .now = (double)rays, .all = all};
    const struct watch watch = {watched_rays_tell, &watched};
    struct path_tally paths;
    int failed = path_tally_open(&paths, t, path_mending_stream(stream)) < 0
                 || path_tally_trace_rays(&paths, t, solve_shown(s)->irradiance, rays, &watch) < 0;
    *tally = paths.tally;
    paths.tally = (struct tally){0};
    path_tally_close(&paths);
    return failed ? -1 : 0;
}

int measure_error(struct solve *s, uint64_t rays, uint64_t stream, int what,
                  struct measured_error *m, const char **cause)
{
    const int surfaces = what & MEASURE_SURFACES, leaves = !(what & MEASURE_NO_LEAVES);
    uint64_t each = surfaces ? rays * 3 / 10 : 0, counted = rays - 2 * each;
    double start = seconds();
    struct tracer t = solve_tracer(s);
    s->told = 0;
    *m = (struct measured_error){0};
    int result =
        tracer_open(&t) < 0 || count(s, &t, counted, (double)rays, stream, leaves, &m->tally) < 0
                || measured_faces(s, &m->tally, m) < 0 || (surfaces && own_quarters_share(s) < 0)
                || (surfaces && measure_surfaces(s, &t, each, stream, m) < 0)
            ? trace_rays_failed(s, cause)
            : 0;
    tracer_close(&t);
    m->seconds = seconds() - start;
    if (result < 0)
        measured_error_free(m);
    return result;
}

void measured_error_free(struct measured_error *m)
{
    face_error_close(&m->faces);
    tally_close(&m->tally);
    element_error_close(&m->elements);
    *m = (struct measured_error){0};
}

int measure_places(struct solve *s, uint64_t rays, struct ray_split *split, const char **cause)
{
    struct tracer t = solve_tracer(s);
    struct tally tally = {0};
    s->told = 0;
    int failed = own_quarters_share(s) < 0;
    const uint32_t elements = s->hierarchy.count;
    failed = failed || tracer_open(&t) < 0 || detail_places(s) < 0
             || tally_open(&tally, &t, MEND_STREAM, 1) < 0
             || trace_rays(s, &t, &tally, rays, (double)rays) < 0
             || ray_split_measure(&s->operator, & tally, s->state.irradiance, split) < 0
             || ray_split_faces(&s->operator, & tally, s->state.irradiance, split) < 0;
    tally_close(&tally);
    tracer_close(&t);
    failed |= detail_drop(s, elements) < 0;
    return failed ? trace_rays_failed(s, cause) : 0;
}
