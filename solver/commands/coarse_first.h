/* coarse_first.h - links as fine as they pay for, or none.
 * SPDX-License-Identifier: MIT */
#ifndef COARSE_FIRST_H
#define COARSE_FIRST_H

#include <jansson.h>
#include "options/options.h"
#include "util/solved.h"

struct coarse_first {
    double scale;   /* of the oracle's link thresholds; 1: as they are set */
    int no_links;   /* 1: none, particles alone; scale means nothing */
    int chosen;     /* by measurement */
    uint64_t rays;  /* of measuring, and of a solve that a finer one came after */
    double seconds; /* for these */
};

/* Solve with the thresholds times o->scale; where that is 0 and o->choose_scale, with no links,
 * coarse ones or as they are set, whichever leaves less to do for links and particles together. The
 * oracle's thresholds are set. Returns 0, or -1 after a message, with nothing to close. */
int coarse_first_solve(struct coarse_first *c, struct solved *s, const struct options *o,
                       RadDevice device, RadScene scene, RadOracle oracle,
                       const struct RadSolveOptions *how);

/* What is printed, if anything, and object `scale` of the JSON. */
void coarse_first_print(const struct coarse_first *c);
json_t *coarse_first_json(const struct coarse_first *c);

#endif
