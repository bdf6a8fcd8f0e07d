/* measured_error.c - see measured_error.h.
 *
 * Particles come by doubling, so that how many there are follows from counts alone and never from
 * the clock: the same solution and the same error for any number of threads.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "engine/measured_error.h"
#include "engine/mend.h"
#include "engine/transport.h"
#include "util/clock.h"

/* particles of each replicate in a first look, which tells how many rays one takes */
enum { FIRST = 64 };

static const char memory[] = "out of memory for counting particles; fewer elements need less";

static struct tracer tracer_of(const struct solve *s)
{
    return (struct tracer){.hierarchy = &s->hierarchy,
                           .rays = s->problem.rays,
                           .exitance = s->problem.exitance,
                           .reflectance = s->problem.reflectance,
                           .bands = s->problem.bands,
                           .threads = s->problem.options.threads};
}

static int tell(void *context, double share)
{
    struct solve *s = context;
    (void)share;
    return solve_tell(s, "particles");
}

/* Trace until about so many rays are cast in all. Returns 0, or -1 when cancelled. */
static int trace_rays(struct solve *s, const struct tracer *t, struct tally *tally, uint64_t rays)
{
    const struct tally_watch watch = {tell, s};
    if (tally->particles == 0 && tally_trace(tally, t, FIRST, &watch) < 0)
        return -1;
    if (tally->rays == 0 || tally->rays >= rays)
        return 0;
    double each = (double)tally->rays / (double)tally->particles;
    double more = (double)(rays - tally->rays) / each;
    return tally_trace(tally, t, more > 1 ? (uint64_t)more : 1, &watch);
}

/* What the tally, which nothing of the shown solution comes from, says of it. */
static int hold_against(struct solve *s, const struct tally *tally, struct measured_error *m)
{
    const struct state *shown = solve_shown(s);
    const struct problem *p = &s->problem;
    size_t values = (size_t)s->hierarchy.count * p->bands;
    m->rays = tally->rays;
    m->particles = tally->particles * REPLICATES;
    m->element = malloc(values * sizeof *m->element);
    if (!m->element)
        return -1;
    memcpy(m->element, shown->irradiance, values * sizeof *m->element);
    if (mend_irradiance(&s->operator, tally, m->element) < 0
        || face_error_open(&m->faces, p, &s->hierarchy, shown->irradiance, tally) < 0) {
        measured_error_free(m);
        return -1;
    }
    for (uint32_t e = 0; e < s->hierarchy.count; e++)
        for (uint32_t k = 0; k < p->bands; k++) {
            const struct element *at = &s->hierarchy.elements[e];
            size_t i = (size_t)e * p->bands + k;
            double rho = at->vertices ? p->reflectance[(size_t)at->face * p->bands + k] : 0;
            double uncovered = s->operator.uncovered[e];
            m->element[i] =
                uncovered > 0 ? rho * (shown->irradiance[i] - m->element[i]) / uncovered : 0;
        }
    return 0;
}

static int give_up(const struct solve *s, const char **cause)
{
    *cause = s->report.cancelled ? "cancelled" : memory;
    return -1;
}

int measure_error(struct solve *s, uint64_t rays, uint64_t stream, struct measured_error *m,
                  const char **cause)
{
    double start = seconds();
    struct tracer t = tracer_of(s);
    struct tally tally = {0};
    *m = (struct measured_error){0};
    int result = tracer_open(&t) < 0 || tally_open(&tally, &t, stream, 1) < 0
                         || trace_rays(s, &t, &tally, rays) < 0 || hold_against(s, &tally, m) < 0
                     ? give_up(s, cause)
                     : 0;
    tally_close(&tally);
    tracer_close(&t);
    m->seconds = seconds() - start;
    return result;
}

void measured_error_free(struct measured_error *m)
{
    face_error_close(&m->faces);
    free(m->element);
    *m = (struct measured_error){0};
}

/* The radiosities that the irradiances of all elements make. */
static void set_radiosity(const struct light_operator *op, struct state *state,
                          const double *by_links)
{
    const struct problem *p = op->problem;
    const struct hierarchy *h = op->hierarchy;
    for (uint32_t e = h->count; e-- > 0;) { /* children follow their parents */
        const struct element *at = &h->elements[e];
        for (uint32_t k = 0; k < p->bands; k++) {
            size_t i = (size_t)e * p->bands + k, of_face = (size_t)at->face * p->bands + k;
            double *B = &state->radiosity[i];
            if (at->children) {
                *B = 0;
                for (int c = 0; c < at->children; c++) {
                    uint32_t j = at->child + (uint32_t)c;
                    *B += operator_share(op, j, e) * state->radiosity[(size_t)j * p->bands + k];
                }
            } else {
                *B = op->uncovered[e] > 0
                         ? p->exitance[of_face]
                               + p->reflectance[of_face] * state->irradiance[i] / op->uncovered[e]
                         : by_links[i];
            }
        }
    }
}

static int mend(struct solve *s, const struct tally *tally)
{
    size_t values = (size_t)s->hierarchy.count * s->problem.bands;
    struct state *m = &s->mended;
    solve_forget_mended(s);
    m->radiosity = malloc(values * sizeof *m->radiosity);
    m->irradiance = malloc(values * sizeof *m->irradiance);
    if (m->radiosity && m->irradiance) {
        memcpy(m->irradiance, s->state.irradiance, values * sizeof *m->irradiance);
        if (mend_irradiance(&s->operator, tally, m->irradiance) == 0) {
            set_radiosity(&s->operator, m, s->state.radiosity);
            return 0;
        }
    }
    solve_forget_mended(s);
    return -1;
}

int measure_and_mend(struct solve *s, double noise, uint64_t most, struct measured_error *alone,
                     const char **cause)
{
    double start = seconds();
    struct tracer t = tracer_of(s);
    struct tally tally = {0};
    *alone = (struct measured_error){0};
    solve_forget_mended(s);
    int failed = tracer_open(&t) < 0 || tally_open(&tally, &t, MEND_STREAM, 1) < 0
                 || trace_rays(s, &t, &tally, 1) < 0;
    for (double left = t.lights.power > 0 ? INFINITY : 0;
         !failed && left > noise && tally.rays < most;) {
        uint64_t twice = 2 * tally.rays;
        failed = trace_rays(s, &t, &tally, twice < most ? twice : most) < 0
                 || face_noise(&s->problem, &s->hierarchy, s->state.irradiance, &tally, &left) < 0;
    }
    failed = failed || hold_against(s, &tally, alone) < 0 || mend(s, &tally) < 0;
    tally_close(&tally);
    tracer_close(&t);
    if (failed) {
        measured_error_free(alone);
        return give_up(s, cause);
    }
    solve_sum_power(s);
    alone->seconds = seconds() - start;
    return 0;
}
