/* stability_tools.c - what the cases of the failure table share.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>
#include "study/stability.h"
#include "terms/form_factor.h"
#include "util/device.h"
#include "util/open_oracle.h"

static double whole_factor(const struct stability_method *method, const struct element *r,
                           const struct element *s)
{
    struct discussion d;
    memset(&d, 0, sizeof d);
    d.receiver = r;
    d.emitter = s;
    double kernel;
    switch ((enum stability_factor)method->number) {
    case FACTOR_KERNEL:
        return form_factor_inverse_square(&d);
    case FACTOR_CULLED:
        kernel = lambert_points(r->centre, r->normal, s->centre, s->normal, 0);
        return kernel < 1e-6 ? 0 : kernel * s->area;
    case FACTOR_DISC:
        return form_factor_disc(&d);
    case FACTOR_POINT:
        return point_factor(r, s);
    case FACTOR_POLYGON:
        return polygon_factor(r, s, 0);
    case FACTOR_CONTOUR:
        return polygon_factor(r, s, 1);
    }
    return NAN;
}

/* The part of e that the digits of `part` in base 4 name, lowest first. */
static struct element part_of(const struct element *e, int level, int part)
{
    struct element whole = *e;
    for (; level > 0; level--, part /= 4) {
        const struct element outer = whole;
        surface_quarter(&outer, part % 4, &whole);
    }
    return whole;
}

double stability_factor(const struct stability_trial *trial, const struct element *r,
                        const struct element *s)
{
    if (trial->level == 0)
        return whole_factor(trial->method, r, s);
    int parts = 1 << 2 * trial->level;
    double sum = 0, area = 0;
    for (int i = 0; i < parts; i++) {
        const struct element to = part_of(r, trial->level, i);
        area += to.area;
        for (int j = 0; j < parts; j++) {
            const struct element from = part_of(s, trial->level, j);
            sum += to.area * whole_factor(trial->method, &to, &from);
        }
    }
    return sum / area;
}

/* Divide by 4^level what decides how far an oracle refines: as --accuracy does, and the shadows of
 * `viewfactors`. */
static void refine_oracle(RadOracle oracle, int level)
{
    struct RadOracleReport report;
    radGetOracleReport(oracle, &report);
    for (int i = 0; i < report.parameter_count; i++) {
        const struct oracle_parameter *p = &report.parameters[i];
        if (!p->fixed
            && (p->role == ROLE_LINK_THRESHOLD || p->role == ROLE_SHADOW_TOLERANCE
                || p->role == ROLE_SMALLEST_PART))
            radSetOracleParameter(
                oracle, p->name,
                fmin(fmax(ldexp(radGetOracleParameter(oracle, p->name), -2 * level), p->low),
                     p->high));
    }
}

/* Made, committed, given an oracle, and solved when `solve`. */
static int make_solution(struct solved *s, const struct made_scene *made,
                         const struct stability_how *how, int solve)
{
    int count = 0, status = -1;
    while (how->settings[count])
        count++;
    RadDevice device = open_device(how->threads);
    RadScene scene = device ? made_commit(made, device, "study stability") : NULL;
    RadOracle oracle = scene ? open_oracle(device, how->oracle, RAD_RELEASE_FLAT,
                                           (char *const *)how->settings, count)
                             : NULL;
    if (oracle && how->level != 0)
        refine_oracle(oracle, how->level);
    if (oracle)
        status = (solve ? solved_open : solved_begin)(s, device, "study stability", scene, oracle,
                                                      &how->options);
    radReleaseOracle(oracle);
    radReleaseScene(scene);
    radReleaseDevice(device);
    return status;
}

int stability_solve_so(struct solved *s, const struct made_scene *made,
                       const struct stability_how *how)
{
    return make_solution(s, made, how, 1);
}

int stability_unsolved(struct solved *s, const struct made_scene *made)
{
    static const char *const none[] = {NULL};
    const struct stability_how how = {
        .oracle = radGetDefaultOracle(), .settings = none, .threads = 1};
    return make_solution(s, made, &how, 0);
}

int stability_solve(struct solved *s, const struct made_scene *made, struct stability_trial *trial,
                    int unit)
{
    const struct stability_method *m = trial->method;
    const struct stability_how how = {
        m->oracle,      m->settings,
        trial->threads, {.tolerance = 1e-6, .closure = (enum RadClosure)m->number, .unit = unit},
        trial->level,
    };
    if (stability_solve_so(s, made, &how) < 0)
        return -1;
    trial->work += (double)s->links.count;
    return 0;
}

int stability_measured(struct stability_trial *trial, const struct stability_scene *scene,
                       double at, double *value)
{
    struct made_scene made = {.count = 0};
    scene->make(&made, at);
    struct solved s;
    if (stability_solve(&s, &made, trial, 0) < 0)
        return -1;
    trial->count = (double)s.links.count;
    *value = scene->measure(&s, at);
    solved_close(&s);
    return 0;
}

void stability_cube_factors(const struct stability_trial *trial, double f[2])
{
    const uint32_t grey[6] = {0, 0, 0, 0, 0, 0};
    struct made_scene cube = {.count = 0};
    made_room(&cube, grey, 1, 1, 1);
    const struct element floor = made_element(&cube, 0), ceiling = made_element(&cube, 1),
                         wall = made_element(&cube, 2);
    f[0] = stability_factor(trial, &floor, &ceiling);
    f[1] = stability_factor(trial, &floor, &wall);
}

const struct element *stability_face(const struct solved *s, uint32_t face)
{
    return &s->elements.elements[s->elements.face_element[face]];
}

/* A F V over the links of e and below that come from face j, or any when j is UINT32_MAX (m2). */
static double add_links(const struct solved *s, uint32_t e, uint32_t j)
{
    const struct element *x = &s->elements.elements[e];
    double sum = 0;
    for (size_t i = s->links.first[e]; i < s->links.first[e + 1]; i++) {
        const struct RadLink *l = &s->links.links[i];
        if (j == UINT32_MAX || s->elements.elements[l->emitter].face == j)
            sum += x->area * (double)l->form_factor * (l->visibility * (1.0 / RAD_LINK_VISIBLE));
    }
    for (uint32_t c = 0; c < x->children; c++)
        sum += add_links(s, x->child + c, j);
    return sum;
}

double stability_exchange(const struct solved *s, uint32_t i, uint32_t j)
{
    return add_links(s, s->elements.face_element[i], j) / stability_face(s, i)->area;
}

double stability_row(const struct solved *s, uint32_t i)
{
    return stability_exchange(s, i, UINT32_MAX);
}

double stability_radiosity(const struct solved *s, uint32_t face)
{
    return s->elements.radiosity[(size_t)s->elements.face_element[face] * s->elements.bands];
}

double stability_irradiance(const struct solved *s, uint32_t face)
{
    return s->elements.irradiance[(size_t)s->elements.face_element[face] * s->elements.bands];
}

int stability_same_links(const struct solved *a, const struct solved *b)
{
    return a->links.count == b->links.count && a->elements.count == b->elements.count
           && memcmp(a->links.links, b->links.links, a->links.count * sizeof *a->links.links) == 0;
}

double stability_random(unsigned *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (*seed >> 8) / 16777216.0;
}

enum stability_verdict stability_judge(const struct stability_case *c,
                                       const struct stability_cell *cell, double error)
{
    if (!cell->why)
        return error <= c->tolerance ? VERDICT_PASSES : VERDICT_FAILS;
    return error > c->tolerance && error >= cell->low && error <= cell->high
               ? VERDICT_FAILS_AS_KNOWN
               : VERDICT_CHANGED;
}

int stability_run(const struct stability_case *c, const struct stability_cell *cell,
                  const struct stability_run *how, struct stability_trial *trial)
{
    trial->method = &stability_methods[cell->method];
    trial->threads = how->threads;
    trial->level = how->level;
    trial->error = NAN;
    trial->count = -1;
    trial->work = trial->method->kind == BY_FACTOR ? ldexp(1, 2 * how->level) : 0;
    if (c->run(trial) < 0)
        return -1;
    if (isnan(trial->error))
        trial->error = INFINITY; /* no number is as wrong as it gets */
    return 0;
}
