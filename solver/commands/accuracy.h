/* accuracy.h - solve until the measured error is what was asked for.
 * SPDX-License-Identifier: MIT */
#ifndef ACCURACY_H
#define ACCURACY_H

#include "commands/error_summary.h"
#include "util/solved.h"

struct accuracy {
    int reached;
    const char *why; /* not reached: what ended it */
    double scale;    /* of the oracle's link thresholds, 1: as they are set */
    int solves, measurements;
    uint64_t rays; /* all of them, of links, mending and measuring */
    double seconds;
};

/* Solve, mend and measure until the error in o->norm is at most o->accuracy with the confidence of
 * the interval, or until o->limit_seconds or ACCURACY_RAYS end it. The oracle's thresholds are set.
 * Returns 0 with the last solution in *s, reached or not; or -1 after a message. */
int accuracy_solve(struct accuracy *a, struct solved *s, struct measured *m,
                   const struct options *o, RadDevice device, RadScene scene, RadOracle oracle,
                   const struct RadSolveOptions *how);

/* What is printed, and object `accuracy` of the JSON. */
void accuracy_print(const struct accuracy *a, const struct options *o);
json_t *accuracy_json(const struct accuracy *a, const struct options *o);

#endif
