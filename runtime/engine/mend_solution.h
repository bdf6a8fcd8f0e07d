/* mend_solution.h - the light of links mended by particles, as many as it takes, and by paths where
 * these are cheaper.
 * SPDX-License-Identifier: MIT */
#ifndef MEND_SOLUTION_H
#define MEND_SOLUTION_H

#include "engine/measured_error.h"
#include "engine/mending_goal.h"

/* Mend the radiosities of the links, which a mended solution then shows. *alone: the links' error
 * as the same particles measure it. Returns 0, or -1 with *cause set. */
int measure_and_mend(struct solve *s, const struct mending_goal *goal, struct measured_error *alone,
                     const char **cause);

#endif
