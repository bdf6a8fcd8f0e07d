/* mended_error.h - how far polygons are off once particles have mended them, before all have come.
 * SPDX-License-Identifier: MIT */
#ifndef MENDED_ERROR_H
#define MENDED_ERROR_H

#include "engine/polygon_counts.h"
#include "engine/mending_goal.h"
#include "engine/solve.h"

/* The L1 error of polygons, as a share of the reflected light, and its upper end (97.5 %). */
struct mended_error {
    double value, most;
};

/* Once the particles of the tally mend the links; noise: what particles alone would leave. The
 * solution stays as it is. Returns 0, or -1 on all ranks when any is out of memory. */
int mended_error_find(const struct solve *s, const struct tally *tally,
                      const struct face_noise *noise, struct mended_error *error);

/* How many times the particles bring that error to the goal. */
double mended_error_wanted(double error, double noise, double goal);

/* How many times the particles of the tally, or its paths, are wanted for polygons: for their noise
 * there (*alone), or, where that is fewer, for what mending leaves. Returns 0, or -1 on all ranks
 * when any is out of memory. */
int mended_error_times(const struct solve *s, const struct tally *tally,
                       const struct mending_goal *goal, double *times, double *alone);

/* By how many times the rays may grow before that is asked again, by `most` at the most. */
double mended_error_growth(const struct mending_goal *goal, double rays, double most);

#endif
