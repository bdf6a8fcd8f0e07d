/* tune_report.h - what came of a fit, as text and as JSON.
 * SPDX-License-Identifier: MIT */
#ifndef TUNE_REPORT_H
#define TUNE_REPORT_H

#include <jansson.h>
#include "commands/tune_fit.h"

/* A fit without one scene, and what its parameters are worth on that scene. What scenes need is
 * told in what they need with the parameters that were fitted to all, a mean over factors. */
struct tune_fold {
    struct tune_fit fit;
    int known; /* 1: all of the following is */
    double used, left, ratio;
    double used_error, left_error; /* mean over scenes; shares of the reflected light */
};

struct tune_outcome {
    const char *oracle;
    struct tuner *tuner;
    struct tune_fit all;
    struct tune_fold *folds; /* [fold_count]; 0: one scene alone is not left out */
    int fold_count;
    double seconds;
};

/* The largest ratio of the folds. NAN: they are not all known. */
double tune_worst(const struct tune_outcome *o);
/* How much worse scenes left out may be than those used. */
#define TUNE_CARRIES 1.5

void tune_print(const struct tune_outcome *o);
/* NULL: out of memory. */
json_t *tune_json(const struct tune_outcome *o);

#endif
