/* api_ranks.c - what each of several processes has of a solution, and what it has told the others.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include "engine/api.h"

_Static_assert((int)RAD_TRAFFICS == (int)RANKS_KINDS
                   && (int)RAD_TRAFFIC_PARTICLES == (int)RANKS_PARTICLES,
               "traffic is told as it is counted");

int radGetRanks(RadSolution solution, struct RadRank *ranks, int most)
{
    if (api_not_dead(solution) < 0)
        return 0;
    const struct solve *s = &solution->solve;
    const struct shares *shares = &s->operator.shares;
    const int count = ranks_count(shares->ranks);
    struct RadRank *all = calloc((size_t)count, sizeof *all);
    if (ranks_any(shares->ranks, !all)) {
        free(all);
        api_fail(solution->scene->device, RAD_ERROR_OUT_OF_MEMORY, "out of memory for %d ranks",
                 count);
        return 0;
    }
    const struct face_range here = shares_here(shares);
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    struct RadRank *mine = &all[ranks_number(shares->ranks)];
    *mine = (struct RadRank){.links = s->refinement.link_count,
                             .pairs = s->refinement.pairs,
                             .rays = rays_count(s->problem.rays).rays,
                             .faces = here.to - here.from,
                             .ghosts = shares->here.first[SWEEP_BLOCKS],
                             .memory = 1024 * (double)usage.ru_maxrss};
    for (int k = 0; k < RAD_TRAFFICS; k++)
        mine->sent[k] = ranks_sent(shares->ranks, (enum ranks_kind)k);
    ranks_complete_parts(shares->ranks, RANKS_VALUES, all, sizeof *all, (size_t)count);
    for (int k = 0; k < count && k < most && ranks; k++)
        ranks[k] = all[k];
    free(all);
    return count;
}
