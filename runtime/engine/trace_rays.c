/* trace_rays.c - see trace_rays.h.
 * SPDX-License-Identifier: MIT */
#include "engine/trace_rays.h"

#include <math.h>

#include "particles/power_balance.h"

/* particles of each replicate in a first look, which tells how many rays one takes */
enum { FIRST = 64 };

int watched_rays_tell(void *context, double share)
{
    const struct watched_rays *w = context;
    /* what is foretold of a stretch may be a little more than it takes: never less is told */
    double rays = fmax((double)w->before + share * w->now, w->solve->told);
    w->solve->told = rays;
    const struct counting counting = {(uint64_t)rays, rays < w->all ? rays / w->all : 1};
    w->solve->counting = &counting;
    int quit = solve_tell(w->solve, "particles");
    w->solve->counting = NULL;
    return quit;
}

int trace_rays(struct solve *s, const struct tracer *t, struct tally *tally, uint64_t rays,
               double all)
{
    struct watched_rays watched = {.solve = s, .all = all};
    const struct watch watch = {watched_rays_tell, &watched};
    if (tally->particles == 0 && tally_trace_part(tally, t, FIRST, &watch) < 0)
        return -1;
    if (tally->rays == 0 || tally->rays >= rays) {
        power_balance(tally, t);
        return 0;
    }
    double each = (double)tally->rays / (double)tally->particles;
    double more = (double)(rays - tally->rays) / each;
    watched.before = tally->rays;
    watched.now = (double)(rays - tally->rays);
    if (tally_trace_part(tally, t, more > 1 ? (uint64_t)more : 1, &watch) < 0)
        return -1;
    power_balance(tally, t);
    return 0;
}

int trace_rays_failed(const struct solve *s, const char **cause)
{
    *cause = s->report.cancelled ? "cancelled"
                                 : "out of memory for counting particles; fewer elements need less";
    return -1;
}
