/* extrapolation.h - where sweeps converge slowly, a guess of what they converge to.
 *
 * In a white room nearly all that a sweep leaves is one mode, the light that has been reflected
 * for long, and each sweep takes the same small share of it: changes shrink by one factor q. Then
 * what all sweeps to come would add is q / (1 - q) times the last change. A sweep's bound asks
 * nothing of what it starts from (transport.c), so a bad guess costs sweeps and no accuracy.
 * Invariant: all ranks guess alike, as they do of changes that are added up over all.
 * [Aitken 1926, of a vector with one factor for all]
 * SPDX-License-Identifier: MIT */
#ifndef EXTRAPOLATION_H
#define EXTRAPOLATION_H

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "kernel/constants.h"

/* All 0 before the first sweep. */
struct extrapolation {
    double *before;       /* what values were before the sweep; owned, NULL: not asked for */
    double change, ratio; /* of the last sweep, and to the one before */
    int steady;           /* sweeps in a row whose ratio stays */
};

/* Before a sweep: values are kept where a guess is near. Out of memory there is none. */
static inline void extrapolation_keep(struct extrapolation *g, const double *value, size_t count)
{
    if (g->steady + 1 < EXTRAPOLATION_STEADY)
        return;
    if (!g->before)
        g->before = malloc(count * sizeof *g->before);
    if (g->before)
        memcpy(g->before, value, count * sizeof *g->before);
}

/* After a sweep that has changed so much of all, any norm: by which factor is the change to be
 * added to what there is? 0: it is not. */
static inline double extrapolation_factor(struct extrapolation *g, double change)
{
    const double ratio = g->change > 0 ? change / g->change : 0;
    const int stays = ratio > EXTRAPOLATION_SLOW && ratio < 1
                      && fabs(ratio - g->ratio) < EXTRAPOLATION_NEAR * (1 - ratio);
    g->steady = stays ? g->steady + 1 : 0;
    g->change = change;
    g->ratio = ratio;
    return g->steady >= EXTRAPOLATION_STEADY ? ratio / (1 - ratio) : 0;
}

/* Add it; the next ratios are of other modes. */
static inline void extrapolation_add(struct extrapolation *g, double factor, double *value,
                                     size_t count)
{
    for (size_t i = 0; i < count && g->before; i++)
        value[i] += factor * (value[i] - g->before[i]);
    g->steady = 0;
    g->change = 0;
}

static inline void extrapolation_close(struct extrapolation *g)
{
    free(g->before);
    g->before = NULL;
}

#endif
