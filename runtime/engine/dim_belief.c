/* dim_belief.c - see dim_belief.h.
 *
 * Means are taken by the inverse of variances: of mending and paths, then of both and split
 * particles. A bright spot that one path in a million finds is missed by nearly all, which then
 * agree: so where paths are farther from mending than DIM_MISSED standard errors, they are thought
 * to be off by what noise does not explain.
 *
 * Paths end in the solution, and where that is wrong so are they, whatever their noise. Split
 * particles have no such bias: where these say otherwise, by MEND_EVIDENCE standard errors, mending
 * and paths are thought to be off in the same way.
 *
 * What all of them end in, or have been scaled to, is all light that is reflected: no polygon is
 * surer than that. And one that nobody has found any light on is not known to be dark.
 *
 * Fails: where the two agree by chance. [Derived here]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include "engine/dim_belief.h"
#include "kernel/constants.h"

void dim_count_replicates(const struct dim_faces *d, const struct tally *tally,
                          const struct dim_polygon *p, double sum[REPLICATES])
{
    const struct tracer *t = d->tracer;
    for (int r = 0; r < REPLICATES; r++) {
        sum[r] = 0;
        for (uint32_t i = p->from; i < p->to; i++)
            for (uint32_t k = 0; k < t->bands && tally_holds(tally, d->face[i]); k++)
                sum[r] += t->reflectance[(size_t)d->face[i] * t->bands + k]
                          * tally_face(tally, r, d->face[i], k) / p->area;
    }
}

double dim_light_of(const double sum[REPLICATES], double *variance)
{
    double mean = 0, square = 0;
    for (int r = 0; r < REPLICATES; r++) {
        mean += sum[r] / REPLICATES;
        square += sum[r] * sum[r] / REPLICATES;
    }
    *variance = fmax(square - mean * mean, 0) / (REPLICATES - 1);
    return mean;
}

/* One thing unseen is allowed for, lest what is dark by chance seem certain: one more path, which
 * finds as much as an average place of the scene reflects. */
double dim_path_variance(const struct dim_faces *d, const struct dim_polygon *p)
{
    double n = (double)p->paths, mean = p->all / n;
    return fmax((p->square + d->unseen * d->unseen) / n - mean * mean, 0) * n / (n - 1);
}

/* The variance of what is so far apart from something else, whose variance is known: where that is
 * more than so many standard errors of both, what noise does not explain. */
static double doubted(double variance, double apart, double other, double errors)
{
    const double square = apart * apart;
    return square > errors * errors * (variance + other) ? square - other : variance;
}

int dim_paths_miss(const struct dim_faces *d, const struct dim_polygon *p)
{
    const double n = (double)p->paths, variance = dim_path_variance(d, p) / n;
    return doubted(variance, p->all / n - p->light, p->variance, DIM_MISSED) > variance;
}

double dim_path_weight(const struct dim_faces *d, const struct dim_polygon *p)
{
    const double n = (double)p->paths,
                 variance = doubted(dim_path_variance(d, p) / n, p->all / n - p->light, p->variance,
                                    DIM_MISSED);
    return p->variance / (p->variance + variance);
}

/* The share of paths that is believed. What a first look found says as little of its own noise as
 * of the light: it is not believed without more. */
static double belief(const struct dim_faces *d, const struct dim_polygon *p)
{
    return p->paths >= DIM_ENOUGH * p->looked ? dim_path_weight(d, p) : 0;
}

/* What mending and paths say of its light, and the variance of that. */
static double light_of_both(const struct dim_faces *d, const struct dim_polygon *p,
                            double *variance)
{
    double weight = belief(d, p);
    *variance = (1 - weight) * p->variance;
    return (1 - weight) * p->light + weight * p->all / (double)p->paths;
}

/* The share of split particles in the mean of all. Paths end in the solution, and where that is
 * wrong so are they: these show it, as far as the two are farther apart than by their own noise. */
static double split_weight(const struct dim_faces *d, const struct dim_polygon *p)
{
    double variance, both = light_of_both(d, p, &variance);
    if (!(p->split_variance > 0))
        return 0;
    variance = doubted(variance, both - p->split_light, p->split_variance, MEND_EVIDENCE);
    return variance / (variance + p->split_variance);
}

int dim_is_sure(const struct dim_faces *d, const struct dim_polygon *p)
{
    if (dim_is_blind(p))
        return 1;
    double variance, both = light_of_both(d, p, &variance), weight = split_weight(d, p);
    if (weight > 0)
        variance = weight * p->split_variance;
    return dim_is_known(d, (1 - weight) * both + weight * p->split_light, variance, DIM_GOAL);
}

double dim_mean(const struct dim_faces *d, const struct dim_polygon *p, uint32_t band)
{
    if (!p->reflects[band])
        return p->mended[band];
    double weight = belief(d, p), split = split_weight(d, p),
           both = (1 - weight) * p->mended[band] + weight * p->sum[band] / (double)p->paths;
    return (1 - split) * both + split * p->split[band];
}
