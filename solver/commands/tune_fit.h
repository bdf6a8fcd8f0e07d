/* tune_fit.h - what an oracle's parameters are worth on scenes, and the best of them.
 *
 * A parameter is looked for in logarithms, at quarters of doublings of its default, which are
 * numbers of two digits: what is measured is what is written. All that was solved is remembered, so
 * that fits over most of the same scenes cost little more than one.
 * SPDX-License-Identifier: MIT */
#ifndef TUNE_FIT_H
#define TUNE_FIT_H

#include <stdint.h>
#include "commands/tune_scene.h"
#include "util/pattern_search.h"
#include "util/progress.h"

struct tune_parameter {
    const char *name;
    double value;  /* its default */
    int low, high; /* quarters of doublings of that, closed range */
};

/* What solving a scene costs: counts, since seconds are not the same twice. */
enum tune_cost {
    TUNE_RAYS,  /* rays, and one for each link, which is gathered over in every sweep */
    TUNE_LINKS, /* links */
    TUNE_TIME   /* TUNE_PAIR rays for each discussion, and the rays: what takes the time */
};

struct tune_result {
    enum { TUNE_UNKNOWN, TUNE_KNOWN, TUNE_OVER } state; /* OVER: given up at that cost */
    double error;                                       /* L1 of faces, of the reflected light */
    double cost;
    double price; /* cost (1 + (error / target)^2)^(power / 2) */
};

struct tune_point {
    int at[PATTERN_NUMBERS];
    struct tune_result *results; /* [scene_count] */
    uint64_t fits;               /* tune_bit of each fit that has looked here */
};

struct tuner {
    RadOracle oracle;
    struct tune_parameter parameters[PATTERN_NUMBERS];
    int parameter_count;
    struct tune_scene *scenes; /* [scene_count] */
    int scene_count;
    enum tune_cost cost;
    enum RadBasis basis;
    double target; /* error, a share of the reflected light */
    int power;
    int evaluations; /* of one fit, at the most */

    struct progress progress;
    double deadline; /* s, of the clock; 0: none */
    char doing[96];  /* for the progress line */
    double limit;    /* of the cost of the solve under way */
    int cancelled;   /* the progress function has ended it */
    int failed;      /* a message was given */
    int solves;
    double *defaults; /* [scene_count]: the price of each with the defaults */
    struct tune_point *points;
    size_t point_count, point_capacity;
};

struct tune_fit {
    int left_out; /* scene, -1: none */
    struct pattern_found found;
    int at[PATTERN_NUMBERS]; /* what it takes: where the search ended, or nearer to the start */
};

/* Of a doubling; the first step of a search is a doubling, too. */
enum { TUNE_QUARTERS = 4 };

/* How many fits there are: to all scenes, and without each where there are several. */
int tune_fits(const struct tuner *t);

/* The bit of a fit; of more than 63 scenes the last ones share one. */
uint64_t tune_bit(int left_out);

/* The value that stands for a number of quarters of doublings; 0: the default. */
double tune_value(const struct tune_parameter *p, int quarters);

/* Of scenes that are open. Returns 0, or -1 after a message; to be closed in any case. */
int tuner_open(struct tuner *t);
void tuner_close(struct tuner *t);

/* All scenes with the defaults, to begin with. Returns 0, 1 when it was stopped, -1 after a
 * message. */
int tune_defaults(struct tuner *t);

/* Fit to all scenes but `left_out` (-1: to all). Ended before its end, by a signal or the deadline,
 * it holds the best so far. Returns 0, or -1 after a message. */
int tune_fit(struct tuner *t, int left_out, struct tune_fit *fit);

/* A scene with the parameters of a place, solved to its end where it was not yet. Returns 0, 1 when
 * it was stopped, -1 after a message. */
int tune_result(struct tuner *t, const int *at, int scene, struct tune_result *result);

/* A RadProgressFunction; the user is a struct tuner. */
int tune_watch(void *user, const struct RadProgress *at);

#endif
