/* api_views.c - what there is of a solution: values, elements, links and its report.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "engine/api.h"
#include "engine/own_quarters.h"

/* What programs see is what the engine has, under other names. */
_Static_assert(sizeof(struct RadLink) == sizeof(struct link)
                   && offsetof(struct RadLink, form_factor) == offsetof(struct link, form_factor)
                   && offsetof(struct RadLink, visibility) == offsetof(struct link, visibility)
                   && offsetof(struct RadLink, mark) == offsetof(struct link, mark)
                   && (int)RAD_LINK_VISIBLE == (int)LINK_VISIBLE
                   && (int)RAD_LINK_MARKS == (int)LINK_MARKS,
               "RadLink is struct link");

int radGetPolygonValues(RadSolution solution, uint32_t band, double *radiosity, double *irradiance)
{
    if (api_not_dead(solution) < 0)
        return -1;
    const struct solve *s = &solution->solve;
    const struct state *shown = solve_shown(s);
    const struct scene *scene = s->problem.scene;
    const uint32_t bands = s->problem.bands;
    if (band >= bands)
        return api_fail(solution->scene->device, RAD_ERROR_INVALID_ARGUMENT,
                        "there is no band %u; there are %u, from 0", (unsigned)band,
                        (unsigned)bands);
    double *area = calloc(2 * (size_t)scene->input_count, sizeof *area),
           *bare = area ? area + scene->input_count : NULL;
    if (!area)
        return api_fail(solution->scene->device, RAD_ERROR_OUT_OF_MEMORY,
                        "out of memory for values of %u polygons", (unsigned)scene->input_count);
    for (uint32_t i = 0; i < scene->input_count; i++) {
        if (radiosity)
            radiosity[i] = 0;
        if (irradiance)
            irradiance[i] = 0;
    }
    for (uint32_t i = 0; i < scene->face_count; i++) {
        uint32_t e = s->hierarchy.face_element[i], input = scene->faces[i].input;
        double a = s->hierarchy.elements[e].area;
        area[input] += a;
        bare[input] +=
            a * (s->hierarchy.faces[i].light == FACE_DARK ? 1 : s->operator.uncovered[e]);
        if (radiosity)
            radiosity[input] +=
                a * s->operator.uncovered[e] * shown->radiosity[(size_t)e * bands + band];
        if (irradiance)
            irradiance[input] += a * shown->irradiance[(size_t)e * bands + band];
    }
    for (uint32_t i = 0; i < scene->input_count; i++) {
        if (radiosity && bare[i] > 0)
            radiosity[i] /= bare[i];
        if (irradiance && area[i] > 0)
            irradiance[i] /= area[i];
    }
    free(area);
    return 0;
}

void radGetElements(RadSolution solution, struct RadElements *elements)
{
    if (!elements)
        return;
    *elements = (struct RadElements){0};
    if (!solution || solution->dead)
        return;
    const struct solve *s = &solution->solve;
    *elements = (struct RadElements){s->hierarchy.elements,      s->started,
                                     s->hierarchy.built,         s->hierarchy.face_element,
                                     s->problem.bands,           solve_shown(s)->radiosity,
                                     solve_shown(s)->irradiance, s->operator.uncovered,
                                     solve_gradient(s)};
}

void radGetLinks(RadSolution solution, struct RadLinks *links)
{
    if (!links)
        return;
    *links = (struct RadLinks){0};
    if (!solution || solution->dead || !api_refined(solution))
        return;
    const struct refinement *r = &solution->solve.refinement;
    *links = (struct RadLinks){(const struct RadLink *)(const void *)r->links, r->link_count,
                               r->first_link};
}

const struct host *radGetHost(RadSolution solution)
{
    return solution && !solution->dead ? rays_host(solution->solve.problem.rays) : NULL;
}

void radGetReport(RadSolution solution, struct RadReport *report)
{
    if (!report)
        return;
    memset(report, 0, sizeof *report);
    if (!solution || !solution->solve.problem.rays) /* handed on to another */
        return;
    const struct solve *s = &solution->solve;
    const struct row_report *rows = &s->report.rows;
    const struct pass_counts *counts = &s->report.counts;
    const int own = own_quarters(s);
    *report = (struct RadReport){
        .elements = own ? s->quarters.count : s->hierarchy.count,
        .bands = s->problem.bands,
        .links = counts->links,
        .pairs = counts->pairs,
        .rounds = s->report.rounds,
        .rays = counts->rays,
        .link_fingerprint = counts->fingerprint,
        .particle_fingerprint = s->report.particles,
        .passes = s->report.passes,
        .iterations = s->report.sweeps,
        .converged = s->report.converged,
        .solver = s->problem.options.solver,
        .projection = s->problem.options.projection,
        .changing = s->report.changing,
        .residual = s->report.residual,
        .solved = {s->report.bound, s->report.tolerance, s->report.variation},
        .emitted = s->report.emitted,
        .absorbed = s->report.absorbed,
        .rows = {rows->low, rows->high, rows->defect_mean, rows->defect_most, rows->blind_area,
                 rows->moved},
        .closed = s->problem.options.closure == CLOSURE_NONE ? -1 : s->problem.closed,
        .closed_rays = s->problem.closed_rays,
        .importance = {s->importance.sweeps, s->importance.largest, s->importance.mean,
                       s->importance.seen},
        .bracket = {s->bracket.solves, s->bracket.power[0], s->bracket.power[1]},
        .ranking = {s->ranking.asked, s->ranking.all, s->ranking.worst},
        .tolerance = {s->error.target, s->error.largest, s->error.area},
        .power_tolerance = power_tolerance(solution->oracle->refiner, rays_host(s->problem.rays)),
        .seconds = {s->report.seconds.build, s->report.seconds.refine, s->report.seconds.iterate,
                    s->report.seconds.in_rays, s->report.seconds.clusters},
        .linear = {s->linear.sweeps, s->linear.limited, s->linear.flat, s->linear.lowered,
                   s->linear.seconds}};
    memcpy(report->marked, counts->marked, sizeof report->marked);
    for (uint32_t i = 0; i < s->hierarchy.count; i++) {
        const struct element *e = &s->hierarchy.elements[i];
        report->leaves += !e->children;
        report->marked_elements[e->mark % RAD_LINK_MARKS]++;
    }
    if (own) { /* those of others, which bear no mark: oracles that mark have one rank */
        report->leaves = s->quarters.leaves;
        report->marked_elements[0] += s->quarters.count - s->hierarchy.count;
    }
    memcpy(report->decided, counts->decided, sizeof report->decided);
}
