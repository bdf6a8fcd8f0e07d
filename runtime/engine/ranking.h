/* ranking.h - links refined worst first: before each pass, from which error times impact on.
 * SPDX-License-Identifier: MIT */
#ifndef RANKING_H
#define RANKING_H

#include "engine/oracle_inputs.h"

struct ranking {
    int asked;        /* the oracle reads scene.rank */
    double share;     /* of the links, so many may be refined in a pass */
    double budget;    /* links at which nothing more is refined */
    double *priority; /* [capacity]: of the links, in their order (W) */
    double *sorted;   /* [capacity] */
    size_t capacity;
    uint64_t above;    /* links above the rank of the last pass */
    double all, worst; /* W: sum of the priorities when that was set, and the largest */
};

/* By the oracle's parameters; before the first refinement, in which nothing is above the rank. */
void ranking_start(struct ranking *k, const struct refiner *refiner, struct rays *rays);

/* Rank the links and set the rank to be exceeded by as many as may be refined, the worst;
 * changed[e] becomes 1 for their receivers. Returns 0, or -1 when out of memory. */
int ranking_update(struct ranking *k, const struct light_operator *op, struct rays *rays,
                   struct oracle_inputs *in);

void ranking_free(struct ranking *k);

#endif
