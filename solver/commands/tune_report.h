/* tune_report.h - what came of a fit, as text and as JSON.
 * SPDX-License-Identifier: MIT */
#ifndef TUNE_REPORT_H
#define TUNE_REPORT_H

#include <jansson.h>
#include "commands/tune_fit.h"

/* A fit without one scene, and what the scene fares with it. Against what it fares where it was
 * used, which is the other folds, so that scenes need not be alike: each is compared with itself.
 * Both error and cost count: what would be cast for the target's error if particles mended what
 * links leave, at the rate of particles, whose error falls with the root of their rays: cost
 * max(1, error / target)^2. */
struct tune_fold {
    struct tune_fit fit;
    int known;                                /* 1: all of the following is */
    struct tune_result left;                  /* the scene with this fit */
    double used_cost, used_error, used_needs; /* with the others: means, but for the error that of
                                               factors; needs: what would be cast */
    double ratio;                             /* of what would be cast, left out over used */
};

/* What would be cast for the target's error. */
double tune_needs(const struct tuner *t, const struct tune_result *r);

/* How scenes left out fare where fits are held to the start: price over that of the defaults. */
enum { TUNE_PENALTIES = 8 };
struct tune_held {
    double penalty; /* mean logarithm of prices per squared doubling; INFINITY: the start */
    double times;
    double worst; /* the largest ratio of the folds */
};

struct tune_outcome {
    const char *oracle;
    struct tuner *tuner;
    struct tune_fit all;
    struct tune_fold *folds; /* [fold_count]; 0: one scene alone is not left out */
    int fold_count;
    struct tune_held held[TUNE_PENALTIES];
    int penalty, chosen; /* the one of them that fits take; 1: they do */
    double seconds;
};

/* The largest ratio of the folds. NAN: they are not all known. */
double tune_worst(const struct tune_outcome *o);
/* Fits moved, and nothing but the defaults carries over. */
int tune_fails(const struct tune_outcome *o);
/* How much worse scenes left out may be than those used. */
#define TUNE_CARRIES 1.5

void tune_print(const struct tune_outcome *o);
/* NULL: out of memory. */
json_t *tune_json(const struct tune_outcome *o);

#endif
