/* api_account.c - the account of error, asked for by programs.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include "engine/api.h"
#include "engine/error_account.h"
#include "util/clock.h"

struct account_watch {
    RadSolution solution;
    int cancelled;
};

static int watch(void *context, uint64_t done, uint64_t ranges)
{
    struct account_watch *w = context;
    const struct solve *s = &w->solution->solve;
    const struct RadProgress progress = {"account",
                                         s->report.passes,
                                         0,
                                         ranges,
                                         s->hierarchy.face_count - done,
                                         s->refinement.link_count,
                                         rays_count(s->problem.rays).rays,
                                         s->report.residual,
                                         (double)done / fmax(s->hierarchy.face_count, 1)};
    w->cancelled |= api_progress(w->solution->scene->device, &progress);
    return w->cancelled;
}

static int check_options(RadDevice device, const struct RadAccountOptions *o)
{
    if (!(o->reflectance_error >= 0 && o->reflectance_error < 1))
        return api_fail(
            device, RAD_ERROR_INVALID_ARGUMENT,
            "RadAccountOptions.reflectance_error is %g; it takes a number from 0, below "
            "1",
            o->reflectance_error);
    if (!(o->exitance_error >= 0 && isfinite(o->exitance_error)))
        return api_fail(device, RAD_ERROR_INVALID_ARGUMENT,
                        "RadAccountOptions.exitance_error is %g; it takes a number from 0",
                        o->exitance_error);
    return 0;
}

int radAccountErrors(RadSolution solution, const struct RadAccountOptions *given,
                     struct RadAccountReport *report)
{
    static const struct RadAccountOptions defaults;
    const struct RadAccountOptions *o = given ? given : &defaults;
    double start = seconds();
    if (api_solved(solution, "radAccountErrors") < 0)
        return -1;
    RadDevice device = solution->scene->device;
    struct solve *s = &solution->solve;
    if (api_needs(device, report, "radAccountErrors needs a place") < 0
        || api_alone(device, "radAccountErrors") < 0 || check_options(device, o) < 0)
        return -1;
    struct account_watch w = {solution, 0};
    struct error_account account = {
        .solve = s, .options = o, .report = report, .watch = watch, .context = &w};
    if (error_account_make(&account) < 0)
        return w.cancelled
                   ? api_fail(device, RAD_ERROR_CANCELLED, "cancelled by the progress function")
                   : api_fail(device, RAD_ERROR_OUT_OF_MEMORY,
                              "out of memory for the account of error");
    report->seconds = seconds() - start;
    return 0;
}
