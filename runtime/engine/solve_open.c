/* solve_open.c - a solve's arrays: from a scene, with B = E, as its elements grow, and until it
 * ends.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "engine/dense.h"
#include "engine/lights_reach.h"
#include "engine/solve.h"
#include "util/array.h"
#include "util/clock.h"
#include "visibility/enclosure.h"

int solve_make_room(struct solve *s)
{
    struct state *state = &s->state;
    struct light_operator *op = &s->operator;
    uint32_t count = s->hierarchy.count, b = s->problem.bands;
    double **const by_band[] = {&state->radiosity, &state->irradiance};
    double **const single[] = {&op->uncovered, &op->row_scale, &op->row_above, &op->row_share,
                               &op->row};
    for (size_t i = 0; i < sizeof by_band / sizeof *by_band; i++)
        if (array_reserve_beside(by_band[i], count, s->capacity, b * sizeof **by_band[i]) < 0)
            return -1;
    for (size_t i = 0; i < sizeof single / sizeof *single; i++)
        if (array_reserve_beside(single[i], count, s->capacity, sizeof **single[i]) < 0)
            return -1;
    if (array_reserve(&s->inputs.changed, count, &s->capacity, sizeof *s->inputs.changed) < 0)
        return -1;
    for (uint32_t i = s->started; i < count; i++) {
        const struct element *e = &s->hierarchy.elements[i];
        for (uint32_t k = 0; k < b; k++) {
            double *B = &state->radiosity[(size_t)i * b + k];
            *B = e->vertices && e->depth > 0 ? state->radiosity[(size_t)e->parent * b + k] : 0;
            state->irradiance[(size_t)i * b + k] = 0;
        }
        op->uncovered[i] = 1;
    }
    s->started = count;
    s->report.held = count > s->report.held ? count : s->report.held;
    return 0;
}

static double largest(const double *v, uint32_t n)
{
    double most = v[0];
    for (uint32_t i = 1; i < n; i++)
        most = fmax(most, v[i]);
    return most;
}

/* The scene's, unless what is dark is told apart. */
static const struct face *faces_of(const struct problem *p)
{
    const int all = p->options.unit || p->options.all_sides;
    return all || !p->scene->lit ? p->scene->faces : p->scene->lit;
}

/* Returns 0, or -1 when out of memory. */
static int read_materials(struct problem *p)
{
    const struct scene *scene = p->scene;
    size_t values = (size_t)scene->face_count * p->bands;
    p->exitance = malloc(values * sizeof *p->exitance);
    p->reflectance = malloc(values * sizeof *p->reflectance);
    p->whitest = malloc(scene->face_count * sizeof *p->whitest);
    if (!p->exitance || !p->reflectance || !p->whitest)
        return -1;
    for (uint32_t i = 0; i < scene->face_count; i++) {
        const struct RadMaterial *m = &scene->materials[scene->faces[i].material];
        for (uint32_t k = 0; k < p->bands; k++) {
            p->exitance[(size_t)i * p->bands + k] = p->options.unit ? 1 : m->exitance[k];
            p->reflectance[(size_t)i * p->bands + k] = p->options.unit ? 0 : m->reflectance[k];
        }
        p->whitest[i] = largest(&p->reflectance[(size_t)i * p->bands], p->bands);
    }
    return 0;
}

static int is_handed_on(const struct solve_options *o)
{
    return o->handed_on && o->handed_on->rays;
}

static int take_hierarchy(struct solve *s)
{
    const struct problem *p = &s->problem;
    const struct solve_options *o = &p->options;
    if (!is_handed_on(o))
        return hierarchy_build_by(
            &s->hierarchy, faces_of(p), p->scene->face_count,
            o->clusters ? (enum clustering)(o->clusters - 1) : CLUSTERING_DEFAULT, o->threads);
    s->hierarchy = o->handed_on->hierarchy;
    memset(&o->handed_on->hierarchy, 0, sizeof o->handed_on->hierarchy);
    return 0;
}

static struct rays *take_rays(struct solve *s, const double *brightest, const char **cause)
{
    const struct problem *p = &s->problem;
    const struct solve_options *o = &p->options;
    if (!is_handed_on(o))
        return rays_open(&s->hierarchy, brightest, p->whitest, o->threads, cause);
    struct rays *rays = o->handed_on->rays;
    o->handed_on->rays = NULL;
    rays_renew(rays, &s->hierarchy);
    return rays;
}

void solve_hand_on(struct solve *s)
{
    struct handed_on *handed = s->problem.options.handed_on;
    hierarchy_renew(&s->hierarchy);
    handed->hierarchy = s->hierarchy;
    handed->rays = s->problem.rays;
    memset(&s->hierarchy, 0, sizeof s->hierarchy);
    s->problem.rays = NULL;
}

void handed_on_free(struct handed_on *handed)
{
    rays_close(handed->rays);
    hierarchy_free(&handed->hierarchy);
    free(handed->uncovered);
}

int solve_open(struct solve *s, const struct scene *scene, const struct solve_options *options,
               const char **cause)
{
    struct problem *p = &s->problem;
    struct hierarchy *h = &s->hierarchy;
    double *brightest = NULL, start = seconds();
    memset(s, 0, sizeof *s);
    *cause = "out of memory";
    p->scene = scene;
    p->options = *options;
    if (options->solver == RAD_SOLVER_LU
        && dense_too_many(scene->face_count, s->cause, sizeof s->cause)) {
        *cause = s->cause;
        return -1;
    }
    p->bands = options->unit ? 1 : scene->bands;
    s->operator=(struct light_operator){.problem = p, .hierarchy = h, .refinement = &s->refinement};
    if (ranks_any(options->ranks, take_hierarchy(s) < 0))
        goto fail;
    s->report.seconds.clusters = seconds() - start;
    if (shares_open(&s->operator.shares, options->ranks, h) < 0)
        goto fail;
    brightest = malloc(scene->face_count * sizeof *brightest);
    if (ranks_any(options->ranks, !brightest || read_materials(p) < 0 || solve_make_room(s) < 0))
        goto fail;
    /* What emits nothing now or later may be left out of a row only while nobody asks what a row
     * sums to. */
    for (uint32_t i = 0; (options->unit || options->closure != CLOSURE_NONE) && i < h->count; i++)
        h->elements[i].black = 0;
    for (uint32_t i = 0; i < scene->face_count; i++) {
        const double *exitance = &p->exitance[(size_t)i * p->bands];
        brightest[i] = largest(exitance, p->bands);
        h->elements[h->face_element[i]].reflectance = p->whitest[i];
        memcpy(&s->state.radiosity[(size_t)h->face_element[i] * p->bands], exitance,
               p->bands * sizeof *exitance);
    }
    struct transport x = {
        .bands = p->bands, .value = s->state.radiosity, .irradiance = s->state.irradiance};
    transport_average(&s->operator, & x);
    if (oracle_inputs_update(&s->inputs, &s->operator, s->state.radiosity, h) < 0)
        goto fail;
    p->rays = take_rays(s, brightest, cause);
    if (ranks_any(options->ranks, !p->rays))
        goto fail;
    oracle_inputs_guess(p, h);
    p->reflects = lights_reach(p, h);
    if (options->closure != CLOSURE_NONE)
        p->closed = enclosure_decide(p->rays, h, brightest, options->threads, &p->closed_rays);
    free(brightest);
    s->report.seconds.build = seconds() - start;
    return 0;
fail:
    free(brightest);
    solve_close(s);
    return -1;
}

void solve_forget_mended(struct solve *s)
{
    free(s->mended.radiosity);
    free(s->mended.irradiance);
    free(s->mended_gradient);
    s->mended_gradient = NULL;
    s->mended = (struct state){0};
    s->reach = (struct mended_reach){0, 0, 0, 0};
}

void solve_close(struct solve *s)
{
    solve_forget_mended(s);
    refinement_close(&s->refinement);
    separable_links_close(&s->operator.separable);
    shares_close(&s->operator.shares);
    rays_close(s->problem.rays);
    hierarchy_free(&s->hierarchy);
    importance_free(&s->importance);
    error_control_free(&s->error);
    bracket_free(&s->bracket);
    ranking_free(&s->ranking);
    linear_solution_free(&s->linear);
    double *const lists[] = {s->state.radiosity,    s->state.irradiance,   s->operator.uncovered,
                             s->operator.row_scale, s->operator.row_above, s->operator.row_share,
                             s->operator.row,       s->problem.exitance,   s->problem.reflectance,
                             s->problem.whitest};
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++)
        free(lists[i]);
    free(s->inputs.changed);
    quarters_close(&s->quarters);
    free(s->stretch);
    free(s->operator.collocated);
    memset(s, 0, sizeof *s);
}
