/* solve.c - Hanrahan's multigridding around the radiosity iteration: refine, solve, let the oracle see the new
 * radiosities, refine again, until no link changes.
 *
 * The equation is solved in balance.c; what is done about rows that sum to more or less than 1 stands in
 * rows.c; what the oracles see of a solution in publish.c.
 * [Hanrahan et al. 1991, sections 4 and 5]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "engine/error_control.h"
#include "engine/transport.h"
#include "util/clock.h"
#include "engine/enclosure.h"
#include "engine/importance.h"
#include "engine/oracle_inputs.h"
#include "engine/row_sums.h"
#include "engine/solve.h"

/* Where groups are linked there are many links. Passes solve to ROUGH only, less than what oracles do not notice (STALE), until
 * so few links change, one in SETTLED, that one more solve, now to the tolerance, ends it. */
#define ROUGH 0.005
#define SETTLED 1000

/* Where the solver lowers thresholds a pass may be one step of them. */
enum { PASSES = 32, PASSES_OF_ALLOWANCE = 200 };

static double largest(const double *v, uint32_t n)
{
    double most = v[0];
    uint32_t i;
    for (i = 1; i < n; i++)
        most = v[i] > most ? v[i] : most;
    return most;
}

/* Room for `count` values in *list. Returns 0, or -1 and *list as it was. */
static int enlarge(double **list, size_t count)
{
    double *moved = realloc(*list, count * sizeof *moved);
    if (!moved)
        return -1;
    *list = moved;
    return 0;
}

/* Give elements made since the last call their parent's radiosity. Returns 0 or -1. */
static int make_room(struct solve *s)
{
    uint32_t count = s->hierarchy.count, b = s->bands, i, k;
    if (count > s->room) {
        size_t room = (size_t)count + count / 4;
        unsigned char *mark;
        if (enlarge(&s->radiosity, room * b) < 0 || enlarge(&s->irradiance, room * b) < 0 || enlarge(&s->row_scale, room) < 0
            || enlarge(&s->row_above, room) < 0 || enlarge(&s->row_gift, room) < 0 || enlarge(&s->exposed, room) < 0
            || enlarge(&s->least, room * b) < 0 || enlarge(&s->most, room * b) < 0)
            return -1;
        mark = realloc(s->changed, room);
        if (!mark)
            return -1;
        s->changed = mark;
        s->room = (uint32_t)(room > UINT32_MAX ? UINT32_MAX : room);
    }
    for (i = s->started; i < count; i++) {
        const struct element *e = &s->hierarchy.elements[i];
        for (k = 0; k < b; k++) {
            s->radiosity[(size_t)i * b + k] = e->vertices && e->depth > 0 ? s->radiosity[(size_t)e->parent * b + k] : 0;
            s->irradiance[(size_t)i * b + k] = 0;
        }
        s->exposed[i] = 1;
    }
    s->started = count;
    return 0;
}

/* Which part of each new leaf is exposed; from there up, means. `first`: the first new element. */
static void expose(struct solve *s, uint32_t first)
{
    struct element *elements = s->hierarchy.elements;
    uint32_t count = s->hierarchy.count, i;
    int c;
#pragma omp parallel for schedule(dynamic, 64) num_threads(s->options.threads)
    for (i = first; i < count; i++)
        if (elements[i].vertices && !elements[i].children)
            s->exposed[i] = rays_exposed(s->rays, &elements[i]);
    for (i = count; i-- > 0;) {
        if (!elements[i].children)
            continue;
        s->exposed[i] = 0;
        for (c = 0; c < elements[i].children; c++) {
            uint32_t j = elements[i].child + (uint32_t)c;
            s->exposed[i] += s->exposed[j] * elements[j].area / elements[i].area;
        }
    }
}

static void take_materials(struct solve *s)
{
    const struct scene *scene = s->scene;
    uint32_t i, k;
    for (i = 0; i < scene->face_count; i++) {
        const struct material *m = &scene->materials[scene->faces[i].material];
        for (k = 0; k < s->bands; k++) {
            s->exitance[(size_t)i * s->bands + k] = s->options.unit ? 1 : m->exitance[k];
            s->reflectance[(size_t)i * s->bands + k] = s->options.unit ? 0 : m->reflectance[k];
        }
    }
}

int solve_open(struct solve *s, const struct scene *scene, const struct solve_options *options, const char **cause)
{
    size_t values;
    double *brightest = NULL, start = seconds();
    uint32_t i, k;
    memset(s, 0, sizeof *s);
    *cause = "out of memory";
    s->scene = scene;
    s->options = *options;
    s->bands = options->unit ? 1 : scene->bands;
    values = (size_t)scene->face_count * s->bands;
    if (hierarchy_build_by(&s->hierarchy, scene->faces, scene->face_count, options->clusters ? (enum clustering)(options->clusters - 1) : CLUSTERING_DEFAULT,
                           options->threads) < 0)
        return -1;
    s->exitance = malloc(values * sizeof *s->exitance);
    s->reflectance = malloc(values * sizeof *s->reflectance);
    brightest = malloc(scene->face_count * sizeof *brightest);
    s->whitest = malloc(scene->face_count * sizeof *s->whitest);
    if (!s->exitance || !s->reflectance || !brightest || !s->whitest || make_room(s) < 0)
        goto fail;
    take_materials(s);
    /* What emits nothing now or later may be left out of a row only while nobody asks what a row sums to. */
    for (i = 0; (options->unit || options->closure != CLOSURE_NONE) && i < s->hierarchy.count; i++)
        s->hierarchy.elements[i].black = 0;
    for (i = 0; i < scene->face_count; i++) {
        brightest[i] = largest(&s->exitance[(size_t)i * s->bands], s->bands);
        s->whitest[i] = largest(&s->reflectance[(size_t)i * s->bands], s->bands);
        s->hierarchy.elements[s->hierarchy.face_element[i]].reflectance = s->whitest[i];
        for (k = 0; k < s->bands; k++)
            s->radiosity[(size_t)s->hierarchy.face_element[i] * s->bands + k] = s->exitance[(size_t)i * s->bands + k];
    }
    publish(s);
    s->rays = rays_open(&s->hierarchy, brightest, s->whitest, options->threads, cause);
    if (!s->rays)
        goto fail;
    publish_guess(s);
    if (options->closure != CLOSURE_NONE)
        s->closed = enclosure_decide(s);
    free(brightest);
    s->seconds.build = seconds() - start;
    return 0;
fail:
    free(brightest);
    solve_close(s);
    return -1;
}

/* Solve for the radiosities over the links as they are, to `tolerance`. Returns 0 or -1. */
static int iterate(struct solve *s, double tolerance, const char **cause)
{
    struct balance light = { .bands = s->bands, .value = s->radiosity, .irradiance = s->irradiance,
                             .source = s->exitance, .reflectance = s->reflectance, .tolerance = tolerance };
    cluster_light_close(&s->cluster_light);
    if (cluster_light_open(&s->cluster_light, &s->hierarchy, &s->refinement, (int)s->bands, s->options.threads) < 0)
        return -1;
    rows_scale(s);
    *cause = "out of memory";
    if (balance_solve(s, &light) < 0)
        return -1;
    s->converged = light.converged;
    s->residual = light.residual;
    return 0;
}

/* The account of power. */
static void account(struct solve *s)
{
    uint32_t i, k, b = s->bands;
    s->emitted = s->absorbed = 0;
    for (i = 0; i < s->scene->face_count; i++) {
        uint32_t e = s->hierarchy.face_element[i];
        double area = s->hierarchy.elements[e].area;
        for (k = 0; k < b; k++) {
            s->emitted += area * s->exposed[e] * s->exitance[(size_t)i * b + k];
            s->absorbed += area * (1 - s->reflectance[(size_t)i * b + k]) * s->irradiance[(size_t)e * b + k];
        }
    }
}

static void watch(void *context, const struct refinement *refinement)
{
    struct solve *s = context;
    (void)refinement;
    if (s->options.progress)
        s->options.progress(s->options.context, s, "refine");
}

int solve_refine(struct solve *s, const struct refiner *refiner, const char **cause)
{
    double start = seconds();
    *cause = "out of memory while refining; a coarser oracle parameter needs less";
    if (refinement_open(&s->refinement, &s->hierarchy, rays_host(s->rays), refiner, s->options.threads) < 0)
        return -1;
    s->refinement.watch = watch;
    s->refinement.watch_context = s;
    if (refinement_start(&s->refinement) < 0 || refinement_sort(&s->refinement) < 0 || make_room(s) < 0)
        return -1;
    if (!s->options.unit)
        expose(s, 0);
    s->seconds.refine += seconds() - start;
    s->seconds.in_rays = rays_count(s->rays).seconds / s->options.threads;
    return 0;
}

/* Discuss the links of changed elements again and make room for what comes of it. Returns how many changed, or -1. */
static int64_t refine_again(struct solve *s, const char **cause)
{
    uint32_t first = s->hierarchy.count;
    int64_t changed = refinement_again(&s->refinement, s->changed);
    *cause = "out of memory while refining; a coarser oracle parameter needs less";
    if (changed < 0 || (changed > 0 && refinement_sort(&s->refinement) < 0) || make_room(s) < 0)
        return -1;
    expose(s, first);
    return changed;
}

/* Under error control: lower allowances until some link changes for it, or nothing is left to be gained. Returns how many
 * links changed, or -1. */
static int64_t refine_for_error(struct solve *s, const char **cause)
{
    *cause = "out of memory";
    if (allowance_estimate(s) < 0)
        return -1;
    for (;;) {
        uint32_t lowered = allowance_lower(s);
        int64_t changed = refine_again(s, cause);
        if (changed != 0 || lowered == 0)
            return changed;
        memset(s->changed, 0, s->hierarchy.count);
    }
}

static int links_groups(const struct solve *s)
{
    return s->refinement.decided[DECISION_LINK_CLUSTERS] > 0;
}

int solve_run(struct solve *s, const struct refiner *refiner, const char **cause)
{
    int64_t changed = 1;
    int settled = 0, importance = s->options.camera && refiner_reads(refiner, FACT_RECEIVER_IMPORTANCE);
    double error = allowance_target(refiner, rays_host(s->rays));
    *cause = "out of memory";
    if (importance && importance_start(s) < 0)
        return -1;
    if (error > 0)
        allowance_start(s, error);
    if (solve_refine(s, refiner, cause) < 0)
        return -1;
    for (s->passes = 0; changed > 0 && s->passes < (error > 0 ? PASSES_OF_ALLOWANCE : PASSES); s->passes++) {
        double start = seconds(), middle;
        int rough = error <= 0 && links_groups(s), last = rough && settled;
        if (iterate(s, rough && !last && ROUGH > s->options.tolerance ? ROUGH : s->options.tolerance, cause) < 0)
            return -1;
        publish(s);
        if (importance && importance_solve(s) < 0)
            return -1;
        middle = seconds();
        changed = error > 0 ? refine_for_error(s, cause) : last ? 0 : refine_again(s, cause);
        if (changed < 0)
            return -1;
        settled = (uint64_t)changed * SETTLED <= s->refinement.link_count;
        if (rough && settled && !last)
            changed = 1; /* solved roughly: once more */
        s->seconds.iterate += middle - start;
        s->seconds.refine += seconds() - middle;
    }
    s->converged = s->converged && changed == 0;
    s->seconds.in_rays = rays_count(s->rays).seconds / s->options.threads;
    account(s);
    return 0;
}

struct solution solve_solution(const struct solve *s)
{
    struct solution view = { s->scene, &s->hierarchy, s->bands, s->radiosity, s->irradiance };
    return view;
}

void solve_close(struct solve *s)
{
    refinement_close(&s->refinement);
    cluster_light_close(&s->cluster_light);
    rays_close(s->rays);
    hierarchy_free(&s->hierarchy);
    free(s->radiosity);
    free(s->irradiance);
    free(s->row_scale);
    free(s->row_above);
    free(s->row_gift);
    free(s->exposed);
    free(s->whitest);
    importance_free(s);
    allowance_free(s);
    free(s->least);
    free(s->most);
    free(s->changed);
    free(s->exitance);
    free(s->reflectance);
    memset(s, 0, sizeof *s);
}
