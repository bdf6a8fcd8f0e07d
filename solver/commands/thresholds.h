/* thresholds.h - all thresholds of an oracle made coarser or finer together.
 * SPDX-License-Identifier: MIT */
#ifndef THRESHOLDS_H
#define THRESHOLDS_H

#include "radiosity.h"

enum { THRESHOLDS = 32 }; /* the most that are scaled */

/* Thresholds that its author did not fix, and what they were set to. */
struct thresholds {
    RadOracle oracle;
    int count;
    struct threshold {
        const char *name;
        double value, low, high;
        int part; /* 1: the smallest part, which only falls */
    } of[THRESHOLDS];
};

/* As they are set now. The oracle is borrowed. */
void thresholds_open(struct thresholds *t, RadOracle oracle);

/* Set them to so many times that, within their ranges. */
void thresholds_scale(const struct thresholds *t, double scale);

#endif
