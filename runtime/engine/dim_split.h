/* dim_split.h - dim polygons by particles that are split on their way to them.
 * SPDX-License-Identifier: MIT */
#ifndef DIM_SPLIT_H
#define DIM_SPLIT_H

#include "engine/dim_belief.h"

/* Trace by about `rays`, or until `sure` says so after two doublings in succession; what they say
 * of each polygon is noted there. window[element * bands + band]: tally_split, borrowed by *split,
 * which has what they counted. Their rays are added to *d->rays. Returns 0, or -1 when out of
 * memory or stopped; either way tally_close. */
int dim_split_trace(struct dim_faces *d, const float *window, double rays,
                    int (*sure)(const struct dim_faces *d), struct tally *split);

#endif
