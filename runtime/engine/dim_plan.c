/* dim_plan.c - see dim_plan.h.
 * SPDX-License-Identifier: MIT */
#include "engine/dim_plan.h"

#include <math.h>

#include "engine/dim_belief.h"
#include "kernel/constants.h"

/* Its light as far as is known by now, but no less than how uncertain that is (W/m2). */
static double light_known(const struct dim_faces *d, const struct dim_polygon *p)
{
    double weight = p->paths > 0 ? dim_path_weight(d, p) : 0,
           found = p->paths > 0 ? p->all / (double)p->paths : 0;
    return fmax((1 - weight) * p->light + weight * found, sqrt((1 - weight) * p->variance));
}

/* How many paths more make its standard error that share of its light. No fewer than DIM_ENOUGH
 * times the first look in all: what fewer say is not taken. */
static double paths_for(const struct dim_faces *d, const struct dim_polygon *p, double share)
{
    if (dim_is_blind(p))
        return 0;
    double goal = share * light_known(d, p),
           all = dim_path_variance(d, p) * fmax(1 / (goal * goal) - 1 / p->variance, 0);
    return fmax(fmax(all, (double)(DIM_ENOUGH * p->looked)) - (double)p->paths, 0);
}

/* rays that these take. */
static double rays_for(const struct dim_faces *d, const struct dim_polygon *p, double share)
{
    return paths_for(d, p, share) * (double)p->rays / (double)p->paths;
}

/* Give those that reach DIM_GOAL what they need, the cheapest first, as far as the rays allow.
 * Returns how many rays are left. */
static double plan_cheap(struct dim_faces *d, double rays)
{
    for (;;) {
        struct dim_polygon *cheapest = NULL;
        double least = rays;
        for (uint32_t j = 0; j < d->count; j++) {
            struct dim_polygon *p = &d->polygon[j];
            double cost = p->planned ? INFINITY : rays_for(d, p, DIM_GOAL);
            if (cost <= least) {
                least = cost;
                cheapest = p;
            }
        }
        if (!cheapest)
            return rays;
        cheapest->planned = 1;
        cheapest->wanted = cheapest->paths + (uint64_t)paths_for(d, cheapest, DIM_GOAL);
        rays -= least;
    }
}

/* That share of the light for all that are planned, or for all others. */
static double rays_of(const struct dim_faces *d, int planned, double share)
{
    double sum = 0;
    for (uint32_t j = 0; j < d->count; j++)
        sum += d->polygon[j].planned == planned ? rays_for(d, &d->polygon[j], share) : 0;
    return sum;
}

static void give(struct dim_faces *d, int planned, double share)
{
    for (uint32_t j = 0; j < d->count; j++) {
        struct dim_polygon *p = &d->polygon[j];
        if (p->planned == planned)
            p->wanted = p->paths + (uint64_t)paths_for(d, p, share);
    }
}

/* The least share, from `share` to `most`, that these can have by so many rays. */
static double share_within(const struct dim_faces *d, int planned, double share, double most,
                           double rays)
{
    while (share < most && rays_of(d, planned, share) > rays)
        share *= 1.02;
    return share;
}

void dim_plan(struct dim_faces *d, double rays, double most)
{
    for (uint32_t j = 0; j < d->count; j++) {
        d->polygon[j].planned = 0;
        d->polygon[j].wanted = d->polygon[j].paths;
    }
    const double left = d->size != DIM_SMALL_ONES ? plan_cheap(d, rays) : rays,
                 sure = share_within(d, 1, d->sure, DIM_GOAL, most - left),
                 share = share_within(d, 0, DIM_GOAL, 1, left);
    if (sure < DIM_GOAL)
        give(d, 1, sure);
    if (share < 1)
        give(d, 0, share);
}

double dim_plan_rest(struct dim_faces *d)
{
    const double goal = sqrt(fmax(DIM_GOAL * DIM_GOAL - d->shared, 0)) / DIM_MARGIN;
    double rays = 0;
    for (uint32_t j = 0; j < d->count; j++) {
        struct dim_polygon *p = &d->polygon[j];
        p->wanted = p->paths;
        if (dim_is_sure(d, p))
            continue;
        if (!(goal > 0) || dim_paths_miss(d, p))
            return INFINITY;
        p->wanted += (uint64_t)paths_for(d, p, goal);
        rays += (double)(p->wanted - p->paths) * (double)p->rays / (double)p->paths;
    }
    return rays;
}
