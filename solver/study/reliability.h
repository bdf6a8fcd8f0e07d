/* reliability.h - how often tools are wrong about visibility, as the counts of oracle tester say.
 *
 * A bin holds the pairs that are below one threshold of projected area and not below the one
 * before. Of them a share is drawn, which is halved whenever enough have been; a period is the time
 * between two halvings. So each period is a sample of its own share, and what is said of all pairs
 * is a sum over bins and periods, each weighted by the pairs that it stands for: a stratified
 * sample [Cochran, Sampling Techniques, chapter 5]. Half of the drawn pairs are asked of rays, the
 * others of the tools that look at the faces between.
 *
 * Invariant: all numbers are counts of discussions, so they do not depend on threads.
 * SPDX-License-Identifier: MIT */
#ifndef RELIABILITY_H
#define RELIABILITY_H

#include <stdint.h>

#include "radiosity.h"

enum {
    BINS_OF_SOLVE = 8,      /* thresholds of oracle tester */
    RAY_TOOLS = 5,          /* its numbers of rays */
    TOOL_SHAFT = RAY_TOOLS, /* never wrong, but does not always know */
    TOOL_OUTLINE,           /* 64 rays where the faces between are too many */
    STUDY_TOOLS,
    CLASSES = 3, /* none, partial, all */
    NO_ANSWER = CLASSES,
    PERIODS = 40
};

/* Counts of one bin in one period. */
struct period {
    uint64_t pairs;                                     /* below the threshold */
    uint64_t matrix[STUDY_TOOLS][CLASSES][CLASSES + 1]; /* [tool][reference][answer or none] */
};

struct bin {
    struct period periods[PERIODS]; /* [count]; the last is still going on */
    int count;
};

/* The share of wrong answers among those that a tool gave, with its 95 % interval. */
struct verdict {
    uint64_t pairs;         /* that it stands for */
    uint64_t asked, wrong;  /* of the pairs that were drawn: asked, and answered wrongly */
    double answered;        /* share of all pairs that the tool has an answer for */
    double part, low, high; /* of these, wrong; low 0 and high 1 where nobody was asked */
};

/* Of the pairs in bins[0] .. bins[count - 1] together. */
struct verdict judge(const struct bin *bins, int count, int tool);

/* Of the pairs in bins[0] .. bins[count - 1] that were drawn, and which the reference calls
 * `truth`, those that the tool calls `answer`. */
uint64_t count_answers(const struct bin *bins, int count, int tool, int truth, int answer);

/* How many pairs a period has to draw for rays, so that two of them tell the share of wrong answers
 * to `within`, by the tool of rays 0 .. rays - 1 that needs the most. */
uint64_t period_length(const struct bin *bin, int rays, double within);

/* Pairs of the running period that were asked of rays. */
uint64_t period_drawn(const struct bin *bin);

/* Bring the running periods of [count] bins, whose thresholds stand in the oracle from place `slot`
 * on, up to what it has counted since the solve began. */
void read_bins(struct bin *bins, int count, int slot, const struct RadStatistics *statistics);

/* A new period of the bin. Returns 0, or -1: there are no more. */
int next_period(struct bin *bin);

#endif
