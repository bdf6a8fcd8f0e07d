/* ray_split.h - how far links are off, point by point, and how far particles would be.
 * SPDX-License-Identifier: MIT */
#ifndef RAY_SPLIT_H
#define RAY_SPLIT_H

#include "engine/operator.h"
#include "particles/particles.h"

/* Squared error over places, each as a share of the light there, the places weighed by light. */
struct ray_split {
    double links;     /* of links; by chance it may come out below 0 */
    double deviation; /* standard deviation of that */
    double ray;       /* of particles of one ray; of r rays a share 1 / r of it */
    double face;      /* by ray_split_faces: of one ray in the L1 error of polygons */
    uint64_t rays;    /* that told it; 0: nothing is known */
};

/* By what particles say of the irradiances [element * bands + band] of all elements (W/m2). The
 * tally has counts of leaves, added or not. Returns 0, or -1 when out of memory. */
int ray_split_measure(const struct light_operator *op, const struct tally *tally,
                      const double *irradiance, struct ray_split *split);

/* Set split->face: squared noise, as a share of the reflected light, if chance alone spread
 * particles over polygons by these irradiances. Returns 0, or -1 when out of memory. */
int ray_split_faces(const struct light_operator *op, const struct tally *tally,
                    const double *irradiance, struct ray_split *split);

/* How many rays of particles bring links and particles together to an error of `wanted`, root mean
 * square as above. */
double ray_split_wanted(const struct ray_split *split, double wanted);

#endif
