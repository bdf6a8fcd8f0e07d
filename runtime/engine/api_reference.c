/* api_reference.c - references: what polygons radiate by particles and by paths.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "engine/api.h"
#include "engine/face_error.h"
#include "engine/reference.h"

_Static_assert((int)RAD_METHOD_PARTICLES == (int)REFERENCE_PARTICLES
                   && (int)RAD_METHOD_PATHS == (int)REFERENCE_PATHS
                   && (int)RAD_METHODS == (int)REFERENCE_METHODS,
               "enum RadMethod is enum reference_method");

/* Each replicate numbers its particles with 32 bits (particles/sobol_sequence.h). */
static const uint64_t PARTICLES_MOST = (uint64_t)UINT32_MAX * REPLICATES;

struct RadReferenceObject {
    atomic_int holders;
    RadScene scene;
    struct reference reference;
    const char *phase;
    int cancelled, dead; /* dead: it may only be released */
};

RadReference radNewReference(RadScene scene)
{
    if (!scene)
        return NULL;
    if (!scene->committed) {
        api_fail(scene->device, RAD_ERROR_INVALID_OPERATION,
                 "radCommitScene comes before radNewReference");
        return NULL;
    }
    RadReference r = calloc(1, sizeof *r);
    const char *cause = "out of memory for a reference";
    if (!r
        || reference_open(&r->reference, &scene->scene, scene->device->threads,
                          scene->device->ranks, &cause)
               < 0) {
        api_fail(scene->device, api_cause(cause), "%s", cause);
        free(r);
        return NULL;
    }
    atomic_init(&r->holders, 1);
    r->scene = scene;
    radRetainScene(scene);
    return r;
}

void radRetainReference(RadReference reference)
{
    if (reference)
        atomic_fetch_add(&reference->holders, 1);
}

void radReleaseReference(RadReference r)
{
    if (!r || atomic_fetch_sub(&r->holders, 1) != 1)
        return;
    reference_close(&r->reference);
    radReleaseScene(r->scene);
    free(r);
}

static int not_dead(RadReference r)
{
    if (!r)
        return -1;
    return r->dead ? api_fail(r->scene->device, RAD_ERROR_INVALID_OPERATION,
                              "the reference was cancelled or has failed; release it, make another "
                              "and load what was saved")
                   : 0;
}

static int watch(void *context, double share)
{
    RadReference r = context;
    const struct RadProgress progress = {.phase = r->phase,
                                         .pass = 1,
                                         .rays = rays_count(r->reference.solve.problem.rays).rays,
                                         .share = share};
    r->cancelled |= api_progress(r->scene->device, &progress) != 0;
    return r->cancelled;
}

int radTraceReference(RadReference r, enum RadMethod method, uint64_t count)
{
    if (not_dead(r) < 0)
        return -1;
    struct reference *x = &r->reference;
    const struct watch tell = {watch, r};
    int failed = 0;
    if (method == RAD_METHOD_PARTICLES) {
        if (count > PARTICLES_MOST)
            return api_fail(r->scene->device, RAD_ERROR_INVALID_ARGUMENT,
                            "%llu particles are more than the %llu that can be told apart",
                            (unsigned long long)count, (unsigned long long)PARTICLES_MOST);
        uint64_t each = (count + REPLICATES - 1) / REPLICATES;
        r->phase = "particles";
        if (each > x->tally.particles)
            failed = tally_trace(&x->tally, &x->tracer, each - x->tally.particles, &tell);
    } else if (method == RAD_METHOD_PATHS) {
        r->phase = "paths";
        failed = face_paths_trace(&x->paths, &x->tracer, count, &tell);
    } else {
        return api_fail(r->scene->device, RAD_ERROR_INVALID_ARGUMENT,
                        "radTraceReference takes RAD_METHOD_PARTICLES or RAD_METHOD_PATHS");
    }
    if (!failed)
        return 0;
    r->dead = 1;
    return r->cancelled
               ? api_fail(r->scene->device, RAD_ERROR_CANCELLED,
                          "cancelled by the progress function")
               : api_fail(r->scene->device, RAD_ERROR_OUT_OF_MEMORY, "out of memory for paths");
}

int radGetReferenceValues(RadReference r, enum RadMethod method, uint32_t band, double *radiosity,
                          double *deviation)
{
    if (not_dead(r) < 0)
        return -1;
    const struct problem *p = &r->reference.solve.problem;
    const struct scene *scene = p->scene;
    size_t count = scene->input_count;
    if ((int)method < 0 || method >= RAD_METHODS)
        return api_fail(r->scene->device, RAD_ERROR_INVALID_ARGUMENT,
                        "radGetReferenceValues takes one of enum RadMethod");
    if (band >= p->bands)
        return api_fail(r->scene->device, RAD_ERROR_INVALID_ARGUMENT,
                        "there is no band %u; there are %u, from 0", (unsigned)band,
                        (unsigned)p->bands);
    double *mean = malloc((2 * count + 1) * sizeof *mean), *variance = mean ? mean + count : NULL;
    if (!mean
        || reference_irradiance(&r->reference, (enum reference_method)method, band, mean, variance)
               < 0) {
        free(mean);
        return api_fail(r->scene->device, RAD_ERROR_OUT_OF_MEMORY,
                        "out of memory for values of %zu polygons", count);
    }
    for (size_t i = 0; i < count; i++) {
        if (radiosity)
            radiosity[i] = 0;
        if (deviation)
            deviation[i] = 0;
    }
    for (uint32_t i = 0; i < scene->face_count; i++) {
        size_t at = (size_t)i * p->bands + band, input = scene->faces[i].input;
        if (radiosity)
            radiosity[input] = p->exitance[at] + p->reflectance[at] * mean[input];
        if (deviation)
            deviation[input] =
                p->reflectance[at] > 0 ? p->reflectance[at] * sqrt(variance[input]) : 0;
    }
    free(mean);
    return 0;
}

int radMeasureErrorBy(RadSolution solution, RadReference r, struct RadErrorReport *report)
{
    if (not_dead(r) < 0 || api_solved(solution, "radMeasureErrorBy") < 0
        || api_needs(r->scene->device, report, "radMeasureErrorBy needs a place") < 0)
        return -1;
    RadDevice device = solution->scene->device;
    const struct tally *tally = &r->reference.tally;
    if (solution->scene != r->scene)
        return api_fail(device, RAD_ERROR_INVALID_ARGUMENT,
                        "the reference is of another scene than the solution");
    if (tally->particles == 0)
        return api_fail(device, RAD_ERROR_INVALID_OPERATION,
                        "radMeasureErrorBy needs particles: radTraceReference comes first");
    struct solve *s = &solution->solve;
    struct face_error f;
    if (face_error_open(&f, &s->problem, &s->hierarchy, solve_shown(s)->irradiance, tally) < 0)
        return api_fail(device, RAD_ERROR_OUT_OF_MEMORY, "out of memory for errors of polygons");
    *report = api_face_report(&f);
    report->rays = tally->rays;
    report->particles = tally->particles * REPLICATES;
    face_error_close(&f);
    return 0;
}

static double share_of(double power, double share)
{
    return isinf(power) ? power : share * power;
}

int radGetReferenceReport(RadReference r, struct RadReferenceReport *report)
{
    if (not_dead(r) < 0
        || api_needs(r->scene->device, report, "radGetReferenceReport needs a place") < 0)
        return -1;
    const struct reference *x = &r->reference;
    struct reference_summary s;
    if (reference_summary(x, &s) < 0)
        return api_fail(r->scene->device, RAD_ERROR_OUT_OF_MEMORY,
                        "out of memory for the report of a reference");
    const double share = s.reflected > 0 ? 1 / s.reflected : 0;
    *report =
        (struct RadReferenceReport){.traced = {x->tally.particles * REPLICATES, x->paths.paths},
                                    .rays = {x->tally.rays, x->paths.rays},
                                    .emitted = s.emitted,
                                    .reflected = s.reflected,
                                    .unseen = s.unseen,
                                    .difference = share * s.difference,
                                    .deviation = share_of(s.deviation, share),
                                    .chi_square = s.chi_square,
                                    .compared = s.compared};
    for (int i = 0; i < RAD_METHODS; i++)
        report->noise[i] = share_of(s.noise[i], share);
    return 0;
}

size_t radSaveReference(RadReference r, void *bytes, size_t size)
{
    if (not_dead(r) < 0)
        return 0;
    size_t needed = reference_state_size(&r->reference);
    if (bytes && size >= needed)
        reference_state(&r->reference, bytes);
    return needed;
}

int radLoadReference(RadReference r, const void *bytes, size_t size)
{
    const char *cause;
    if (not_dead(r) < 0)
        return -1;
    if (!bytes || reference_restore(&r->reference, bytes, size, &cause) < 0)
        return api_fail(r->scene->device, RAD_ERROR_INVALID_ARGUMENT, "%s",
                        bytes ? cause : "there are no bytes to load");
    return 0;
}
