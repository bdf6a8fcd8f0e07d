/* lights_reach.h - may any light be reflected at all?
 * SPDX-License-Identifier: MIT */
#ifndef LIGHTS_REACH_H
#define LIGHTS_REACH_H

#include "engine/problem.h"

/* 0: no face is in front of one that emits in a band in which it reflects, and that one in front of
 * it; so nothing is reflected once, nor ever. 1: it may be. */
int lights_reach(const struct problem *p, const struct hierarchy *h);

#endif
