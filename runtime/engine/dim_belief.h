/* dim_belief.h - what mending, paths and split particles together say of a dim polygon.
 * SPDX-License-Identifier: MIT */
#ifndef DIM_BELIEF_H
#define DIM_BELIEF_H

#include "engine/dim_paths.h"
#include "particles/particles.h"

/* times the paths of a first look: what fewer say is not believed; chosen, its noise is then halved
 */
enum { DIM_ENOUGH = 4 };

/* What a polygon reflects by each replicate of a tally, mean over it, all bands (W/m2): of those of
 * its faces whose counts are here. */
void dim_count_replicates(const struct dim_faces *d, const struct tally *tally,
                          const struct dim_polygon *p, double sum[REPLICATES]);
/* The mean of them, and the variance of that. */
double dim_light_of(const double sum[REPLICATES], double *variance);

/* The variance of one path, of those that have been traced. */
double dim_path_variance(const struct dim_faces *d, const struct dim_polygon *p);

/* Are paths farther from mending than noise explains? */
int dim_paths_miss(const struct dim_faces *d, const struct dim_polygon *p);

/* The share of paths in the mean of them and mending, each by the inverse of its variance. */
double dim_path_weight(const struct dim_faces *d, const struct dim_polygon *p);

/* Of some light with that variance, and a relative variance that all light shares: is its standard
 * error no more than that share of it? */
static inline int dim_is_known(const struct dim_faces *d, double light, double variance,
                               double share)
{
    const double goal = share * light;
    return light > 0 && variance + d->shared * light * light <= goal * goal;
}

/* Is its standard error, by all, no more than DIM_GOAL of its light? */
int dim_is_sure(const struct dim_faces *d, const struct dim_polygon *p);

/* Its mean irradiance in a band, by all (W/m2). */
double dim_mean(const struct dim_faces *d, const struct dim_polygon *p, uint32_t band);

#endif
