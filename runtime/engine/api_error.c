/* api_error.c - measured error and mended solutions.
 * SPDX-License-Identifier: MIT */
#include <string.h>
#include "engine/api.h"
#include "engine/mend_solution.h"

/* A share of the rays that links have cast, and `more` besides, but no fewer than `least`. */
static uint64_t share_of_rays(RadSolution solution, double share, double more, uint64_t least)
{
    double rays = share * (double)solution->solve.report.counts.rays + more;
    return rays > (double)least ? (uint64_t)rays : least;
}

/* So few rays say little, however cheap the solution was: of a scene, or of each polygon. */
static uint64_t least_rays(RadSolution solution, int surfaces)
{
    uint64_t scene = surfaces ? RAD_MEASURE_SURFACES : RAD_MEASURE_LEAST;
    uint64_t polygons = (uint64_t)RAD_MEASURE_POLYGON * solution->solve.problem.scene->input_count;
    return scene > polygons ? scene : polygons;
}

struct RadErrorReport api_face_report(const struct face_error *f)
{
    struct RadErrorReport r = {.power = f->power,
                               .l1_faces = f->l1,
                               .noise = f->noise,
                               .reflected = f->reflected,
                               .unseen = f->unseen,
                               .worst = f->worst,
                               .worst_share = f->worst_share,
                               .worst_sure = f->worst_sure};
    memcpy(r.band_light, f->band_light, sizeof r.band_light);
    memcpy(r.band_noise, f->band_noise, sizeof r.band_noise);
    return r;
}

static struct RadErrorReport report_of(const struct measured_error *m)
{
    struct RadErrorReport r = api_face_report(&m->faces);
    r.l2 = m->l2;
    r.p999 = m->p999;
    r.backs = m->backs.share;
    r.back = m->backs.most;
    r.back_share = m->backs.most_share;
    r.large = m->dim.large;
    r.gathered = m->gathered;
    r.unsure = m->dim.unsure;
    r.small_unsure = m->small.unsure;
    r.small_area = m->small.area;
    r.rays = m->rays;
    r.particles = m->particles;
    r.by_paths = (uint32_t)m->by_paths;
    r.seconds = m->seconds;
    memcpy(r.unsure_named, m->dim.named, sizeof r.unsure_named);
    return r;
}

int radMeasureError(RadSolution solution, const struct RadMeasureOptions *given,
                    struct RadErrorReport *report)
{
    static const struct RadMeasureOptions defaults;
    const struct RadMeasureOptions *o = given ? given : &defaults;
    if (api_solved(solution, "radMeasureError") < 0)
        return -1;
    if (o->stream > 1u << 31)
        return api_fail(solution->scene->device, RAD_ERROR_INVALID_ARGUMENT,
                        "RadMeasureOptions.stream is %u; it takes 0 to 2^31", (unsigned)o->stream);
    const double mended = solution->solve.by_paths ? RAD_MEASURE_PATHS : RAD_MEASURE_MENDED;
    uint64_t rays = o->rays ? o->rays
                            : share_of_rays(solution, RAD_MEASURE_SHARE,
                                            mended * (double)solution->mending_rays,
                                            least_rays(solution, o->surfaces));
    const char *cause;
    measured_error_free(&solution->measured);
    if (measure_error(&solution->solve, rays, 1 + (uint64_t)o->stream,
                      (o->surfaces ? MEASURE_SURFACES : 0) | (o->polygons ? MEASURE_NO_LEAVES : 0),
                      &solution->measured, &cause)
        < 0)
        return api_give_up(solution, cause);
    if (report)
        *report = report_of(&solution->measured);
    return 0;
}

int radGetPolygonErrors(RadSolution solution, uint32_t band, double *error, double *deviation)
{
    if (api_not_dead(solution) < 0)
        return -1;
    const struct face_error *f = &solution->measured.faces;
    if (!f->error)
        return api_fail(solution->scene->device, RAD_ERROR_INVALID_OPERATION,
                        "nothing has been measured of what is shown: radMeasureError comes first");
    if (band >= f->bands)
        return api_fail(solution->scene->device, RAD_ERROR_INVALID_ARGUMENT,
                        "there is no band %u; there are %u, from 0", (unsigned)band,
                        (unsigned)f->bands);
    for (uint32_t i = 0; i < f->polygons; i++) {
        if (error)
            error[i] = f->error[(size_t)i * f->bands + band];
        if (deviation)
            deviation[i] = f->deviation[(size_t)i * f->bands + band];
    }
    return 0;
}

/* What was measured of the elements that are shown; NULLs: nothing was, or there is no memory. */
static struct element_error element_errors(RadSolution solution)
{
    if (!solution || solution->dead)
        return (struct element_error){NULL, NULL};
    if (measured_elements(&solution->solve, &solution->measured) < 0)
        api_fail(solution->scene->device, RAD_ERROR_OUT_OF_MEMORY,
                 "out of memory for the errors of elements");
    return solution->measured.elements;
}

const double *radGetElementErrors(RadSolution solution)
{
    return element_errors(solution).error;
}

const double *radGetElementErrorLimits(RadSolution solution)
{
    return element_errors(solution).limit;
}

int radMeasurePlaces(RadSolution solution, uint64_t rays, struct RadPlaces *places)
{
    const char *cause;
    if (api_solved(solution, "radMeasurePlaces") < 0)
        return -1;
    if (!rays)
        rays = share_of_rays(solution, RAD_PLACES_SHARE, 0, RAD_PLACES_LEAST);
    if (measure_places(&solution->solve, rays, &solution->places, &cause) < 0)
        return api_give_up(solution, cause);
    if (places)
        *places = (struct RadPlaces){.links = solution->places.links,
                                     .deviation = solution->places.deviation,
                                     .ray = solution->places.ray,
                                     .face = solution->places.face,
                                     .rays = solution->places.rays};
    return 0;
}

/* Rays of mending at most. What n landings tell of a polygon is off by .8 / sqrt(n) in the mean: by
 * a hundredth when RAD_CORRECT_OF_ONE fall on it. */
static uint64_t most_rays(RadSolution solution)
{
    const uint64_t cast = solution->solve.report.counts.rays,
                   polygons = solution->solve.problem.scene->input_count,
                   each = polygons < RAD_CORRECT_OF_ALL / RAD_CORRECT_OF_ONE
                              ? polygons * RAD_CORRECT_OF_ONE
                              : RAD_CORRECT_OF_ALL,
                   most = each > RAD_CORRECT_MOST ? each : RAD_CORRECT_MOST;
    return cast > most ? cast : most;
}

int radCorrect(RadSolution solution, const struct RadCorrectOptions *given,
               struct RadErrorReport *alone)
{
    static const struct RadCorrectOptions defaults;
    const struct RadCorrectOptions *o = given ? given : &defaults;
    if (api_solved(solution, "radCorrect") < 0)
        return -1;
    if (!(o->noise >= 0 && o->noise < 1))
        return api_fail(solution->scene->device, RAD_ERROR_INVALID_ARGUMENT,
                        "RadCorrectOptions.noise is %g; it takes a share above 0 and below 1, or 0 "
                        "for the default",
                        o->noise);
    double noise = o->noise > 0 ? o->noise : RAD_CORRECT_NOISE;
    struct mending_goal goal = {.noise = noise,
                                .most = o->rays,
                                .own = o->own,
                                .look = o->look,
                                .linked = solution->solve.linked};
    if (!o->rays) {
        goal.left = o->noise > 0 ? 0 : RAD_CORRECT_LEFT;
        goal.power = RAD_CORRECT_POWER;
        goal.plain = RAD_CORRECT_PLAIN;
        goal.places = RAD_CORRECT_PLACES;
        goal.least = RAD_CORRECT_LEAST;
        goal.most = most_rays(solution);
        goal.expected = ray_split_wanted(&solution->places, goal.places);
    }
    struct measured_error links;
    const char *cause;
    measured_error_free(&solution->measured);
    if (measure_and_mend(&solution->solve, &goal, &links, &cause) < 0)
        return api_give_up(solution, cause);
    solution->mending_rays = links.rays;
    if (alone)
        *alone = report_of(&links);
    measured_error_free(&links);
    return 0;
}
