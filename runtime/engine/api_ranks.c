/* api_ranks.c - what each of several processes has of a solution or of exchange areas, and what it
 * has told the others.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include "engine/api.h"

_Static_assert((int)RAD_TRAFFICS == (int)RANKS_KINDS && (int)RAD_TRAFFIC_PAIRS == (int)RANKS_PAIRS,
               "traffic is told as it is counted");

/* All are told of what is `mine`, and of what that process has taken. */
static int tell(RadDevice device, const struct RadRank *mine, struct RadRank *to, int most)
{
    struct ranks *ranks = device->ranks;
    const int count = ranks_count(ranks);
    struct RadRank *all = calloc((size_t)count, sizeof *all), *own;
    if (ranks_any(ranks, !all)) {
        free(all);
        api_fail(device, RAD_ERROR_OUT_OF_MEMORY, "out of memory for %d ranks", count);
        return 0;
    }
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    const struct timeval *user = &usage.ru_utime, *system = &usage.ru_stime;
    own = &all[ranks_number(ranks)];
    *own = *mine;
    own->memory = 1024 * (double)usage.ru_maxrss;
    own->seconds =
        (double)(user->tv_sec + system->tv_sec) + 1e-6 * (double)(user->tv_usec + system->tv_usec);
    for (int k = 0; k < RAD_TRAFFICS; k++)
        own->sent[k] = ranks_sent(ranks, (enum ranks_kind)k);
    ranks_complete_parts(ranks, RANKS_VALUES, all, sizeof *all, (size_t)count);
    for (int k = 0; k < count && k < most && to; k++)
        to[k] = all[k];
    free(all);
    return count;
}

int radGetRanks(RadSolution solution, struct RadRank *ranks, int most)
{
    if (api_not_dead(solution) < 0)
        return 0;
    const struct solve *s = &solution->solve;
    const struct shares *shares = &s->operator.shares;
    const struct face_range here = shares_here(shares);
    const struct RadRank mine = {.links = s->refinement.link_count,
                                 .pairs = s->refinement.pairs,
                                 .rays = rays_count(s->problem.rays).rays,
                                 .faces = here.to - here.from,
                                 .ghosts = shares_ghosts(shares),
                                 .named = shares->named,
                                 .elements = s->report.held};
    return tell(solution->scene->device, &mine, ranks, most);
}

int radGetExchangeRanks(RadExchange x, struct RadRank *ranks, int most)
{
    if (!x)
        return 0;
    const struct exchange *e = &x->exchange;
    const struct RadRank mine = {
        .links = e->report.links, .pairs = e->areas.own_count, .rays = e->rays};
    return tell(x->scene->device, &mine, ranks, most);
}
