/* api_causes.c - causes of what links bring wrongly, asked for by programs.
 * SPDX-License-Identifier: MIT */
#include "engine/api.h"
#include "engine/error_causes.h"
#include "util/clock.h"

int radFindCauses(RadSolution solution, const struct RadCausesOptions *given,
                  struct RadCausesReport *report)
{
    static const struct RadCausesOptions defaults;
    const struct RadCausesOptions *o = given ? given : &defaults;
    double start = seconds();
    if (api_solved(solution, "radFindCauses") < 0)
        return -1;
    RadDevice device = solution->scene->device;
    struct solve *s = &solution->solve;
    if (api_needs(device, report, "radFindCauses needs a place") < 0
        || api_alone(device, "radFindCauses") < 0)
        return -1;
    if (s->problem.options.linear)
        return api_fail(device, RAD_ERROR_INVALID_OPERATION,
                        "radFindCauses knows constants alone: RAD_BASIS_CONSTANT");
    if (o->rays > (uint64_t)1 << 32)
        return api_fail(device, RAD_ERROR_INVALID_ARGUMENT,
                        "RadCausesOptions.rays is %llu; it takes at most 2^32",
                        (unsigned long long)o->rays);
    if (error_causes_find(s, o->rays ? o->rays : RAD_CAUSES_RAYS, o->stream, report) < 0)
        return api_give_up(solution,
                           "out of memory for the causes of error; fewer elements need less");
    report->seconds = seconds() - start;
    return 0;
}
