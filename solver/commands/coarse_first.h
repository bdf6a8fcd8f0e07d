/* coarse_first.h - links as fine as they pay for, or none.
 * SPDX-License-Identifier: MIT */
#ifndef COARSE_FIRST_H
#define COARSE_FIRST_H

#include <jansson.h>
#include "options/options.h"
#include "util/solved.h"

struct coarse_first {
    struct RadChoice choice;
    int chosen; /* by measurement */
};

/* Solve with the thresholds times o->scale; where that is 0 and o->choose_scale, with as many links
 * as pay (radSolveScene). Returns 0, or -1 after a message, with nothing to close. */
int coarse_first_solve(struct coarse_first *c, struct solved *s, const struct options *o,
                       RadDevice device, RadScene scene, RadOracle oracle,
                       const struct RadSolveOptions *how);

/* What is printed, if anything, and object `scale` of the JSON. */
void coarse_first_print(const struct coarse_first *c);
json_t *coarse_first_json(const struct coarse_first *c);

#endif
