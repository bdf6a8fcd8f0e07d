/* allowance.h - link thresholds that follow the error of the radiosities they lead to.
 * SPDX-License-Identifier: MIT */
#ifndef ALLOWANCE_H
#define ALLOWANCE_H

#include "engine/solve.h"

/* The error of radiosity to be held (W/m2), by the oracle's own parameters: the larger of `epsilon` and `relative` times
 * the scene's mean radiosity. 0 when the oracle reads no allowance, or has no such parameter. */
double allowance_target(const struct refiner *refiner, const struct host *host);

/* Before the first refinement: what each face's links may be off by. */
void allowance_start(struct solve *s, double target);

/* Estimate every leaf's error anew. Returns 0, or -1 when out of memory. */
int allowance_estimate(struct solve *s);

/* Lower the allowance of leaves whose estimate is above the target, and of what they are part of; changed[e] becomes 1
 * where it fell. Returns how many leaves it was lowered of; 0: nothing is above, or nothing is left that could help. */
uint32_t allowance_lower(struct solve *s);

void allowance_free(struct solve *s);

#endif
