/* stability_tools.c - what the cases of the failure table share.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>
#include "scene/make_scene.h"
#include "oracle/oracles.h"
#include "study/stability.h"
#include "terms/form_factor.h"

double stability_factor(const struct stability_method *method, const struct element *r, const struct element *s)
{
    struct discussion d;
    double axis[3], square, cos_r, cos_s, kernel;
    memset(&d, 0, sizeof d);
    d.receiver = r;
    d.emitter = s;
    switch ((enum stability_factor)method->number) {
    case FACTOR_KERNEL:
    case FACTOR_CULLED:
        sub3(axis, s->centre, r->centre);
        square = dot3(axis, axis);
        cos_r = dot3(r->normal, axis);
        cos_s = -dot3(s->normal, axis);
        kernel = cos_r > 0 && cos_s > 0 ? cos_r * cos_s / (LAMBERT_PI * square * square) : 0;
        return method->number == FACTOR_CULLED && kernel < 1e-6 ? 0 : kernel * s->area;
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

int stability_solve(struct solve *s, const struct scene *scene, const struct stability_trial *trial, int unit)
{
    const struct stability_method *m = trial->method;
    struct solve_options how = { .tolerance = 1e-6, .iterations = 100000, .threads = trial->threads, .unit = unit,
                                 .closure = (enum closure)m->number };
    struct refiner *refiner = oracles_open(m->oracle, RELEASE_FLAT);
    const char *cause;
    int n = 0, status;
    while (m->settings[n])
        n++;
    if (!refiner)
        return -1;
    if (oracles_set(refiner, (char *const *)m->settings, n) < 0 || solve_open(s, scene, &how, &cause) < 0) {
        refiner_close(refiner);
        return -1;
    }
    status = unit ? solve_refine(s, refiner, &cause) : solve_run(s, refiner, &cause);
    refiner_close(refiner);
    if (status < 0)
        solve_close(s);
    return status;
}

int stability_measured(struct stability_trial *trial, const struct stability_scene *scene, double at, double *value)
{
    struct scene made;
    struct solve s;
    int status = made_open(&made);
    if (status == 0) {
        scene->make(&made, at);
        status = stability_solve(&s, &made, trial, 0);
    }
    if (status == 0) {
        trial->count = (double)s.refinement.link_count;
        *value = scene->measure(&s, at);
        solve_close(&s);
    }
    made_close(&made);
    return status;
}

int stability_cube_factors(const struct stability_method *method, double f[2])
{
    const uint32_t grey[6] = { 0, 0, 0, 0, 0, 0 };
    struct scene scene;
    struct hierarchy h;
    int status = made_open(&scene);
    if (status == 0) {
        made_material(&scene, 0.5, 0);
        made_room(&scene, grey, 1, 1, 1);
        status = hierarchy_build(&h, scene.faces, scene.face_count);
    }
    if (status < 0) {
        made_close(&scene);
        return -1;
    }
    f[0] = stability_factor(method, &h.elements[h.face_element[0]], &h.elements[h.face_element[1]]);
    f[1] = stability_factor(method, &h.elements[h.face_element[0]], &h.elements[h.face_element[2]]);
    hierarchy_free(&h);
    made_close(&scene);
    return 0;
}

/* A F V over the links of e and below that come from face j, or any when j is UINT32_MAX (m2). */
static double add_links(const struct solve *s, uint32_t e, uint32_t j)
{
    const struct element *x = &s->hierarchy.elements[e];
    double sum = 0;
    size_t i;
    int c;
    for (i = s->refinement.first_link[e]; i < s->refinement.first_link[e + 1]; i++) {
        const struct link *l = &s->refinement.links[i];
        if (j == UINT32_MAX || s->hierarchy.elements[l->emitter].face == j)
            sum += x->area * (double)l->form_factor * (l->visibility * (1.0 / LINK_VISIBLE));
    }
    for (c = 0; c < x->children; c++)
        sum += add_links(s, x->child + (uint32_t)c, j);
    return sum;
}

double stability_exchange(const struct solve *s, uint32_t i, uint32_t j)
{
    uint32_t e = s->hierarchy.face_element[i];
    return add_links(s, e, j) / s->hierarchy.elements[e].area;
}

double stability_row(const struct solve *s, uint32_t i)
{
    return stability_exchange(s, i, UINT32_MAX);
}

double stability_radiosity(const struct solve *s, uint32_t face)
{
    return s->radiosity[(size_t)s->hierarchy.face_element[face] * s->bands];
}

double stability_irradiance(const struct solve *s, uint32_t face)
{
    return s->irradiance[(size_t)s->hierarchy.face_element[face] * s->bands];
}

int stability_same_links(const struct solve *a, const struct solve *b)
{
    return a->refinement.link_count == b->refinement.link_count && a->hierarchy.count == b->hierarchy.count
        && memcmp(a->refinement.links, b->refinement.links, a->refinement.link_count * sizeof(struct link)) == 0;
}

double stability_random(unsigned *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (*seed >> 8) / 16777216.0;
}

enum stability_verdict stability_judge(const struct stability_cell *cell, double error)
{
    if (!cell->why)
        return error <= cell->tolerance ? VERDICT_PASSES : VERDICT_FAILS;
    return error > cell->tolerance && error >= cell->low && error <= cell->high ? VERDICT_FAILS_AS_KNOWN : VERDICT_CHANGED;
}

int stability_run(const struct stability_case *c, const struct stability_cell *cell, int threads, struct stability_trial *trial)
{
    trial->method = &stability_methods[cell->method];
    trial->threads = threads;
    trial->error = NAN;
    trial->count = -1;
    if (c->run(trial) < 0)
        return -1;
    if (isnan(trial->error))
        trial->error = INFINITY; /* no number is as wrong as it gets */
    return 0;
}
