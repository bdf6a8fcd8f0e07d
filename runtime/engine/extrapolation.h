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

/* Of what is guessed: means, and slopes where there are any. */
enum { GUESS_MEANS, GUESS_SLOPES, GUESSES };

/* All 0 before the first sweep. */
struct extrapolation {
    double *before[GUESSES]; /* what values were before the sweep; owned, NULL: not asked for */
    double change, ratio;    /* of the last sweep, and to the one before */
    int steady;              /* sweeps in a row whose ratio stays */
};

/* Before a sweep: values are kept where a guess is near. Out of memory they are not guessed. */
static inline void extrapolation_keep(struct extrapolation *g, int what, const double *value,
                                      size_t count)
{
    if (g->steady + 1 < EXTRAPOLATION_STEADY)
        return;
    if (!g->before[what])
        g->before[what] = malloc(count * sizeof *value);
    if (g->before[what])
        memcpy(g->before[what], value, count * sizeof *value);
}

/* After a sweep that has changed so much (W, any norm; not a share of the light, which shrinks or
 * grows itself): by which factor is the change to be added to what there is? 0: it is not. Then the
 * next ratios are of other modes. */
static inline double extrapolation_factor(struct extrapolation *g, double change)
{
    const double ratio = g->change > 0 ? change / g->change : 0;
    const int stays = ratio > EXTRAPOLATION_SLOW && ratio < 1
                      && fabs(ratio - g->ratio) < EXTRAPOLATION_NEAR * (1 - ratio);
    g->steady = stays ? g->steady + 1 : 0;
    g->change = change;
    g->ratio = ratio;
    if (g->steady < EXTRAPOLATION_STEADY)
        return 0;
    g->steady = 0;
    g->change = 0;
    return ratio / (1 - ratio);
}

static inline void extrapolation_add(const struct extrapolation *g, int what, double factor,
                                     double *value, size_t count)
{
    const double *before = g->before[what];
    for (size_t i = 0; i < count && before; i++)
        value[i] += factor * (value[i] - before[i]);
}

static inline void extrapolation_close(struct extrapolation *g)
{
    for (int what = 0; what < GUESSES; what++)
        free(g->before[what]);
}

#endif
