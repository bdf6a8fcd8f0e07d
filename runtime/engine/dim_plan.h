/* dim_plan.h - how many paths each dim polygon gets.
 *
 * So many that 1 / (1 / s^2 + n / v), v the variance of one, is the square of DIM_GOAL of its
 * light. Few tell first how noisy they are and how much light there is. Then polygons get what they
 * need, the cheapest first, so that few are left wrong; what remains makes the others equally sure.
 * Small polygons are all to be equally sure: there are too many to get some of them right and leave
 * the others as they are. [derived here]
 * SPDX-License-Identifier: MIT */
#ifndef DIM_PLAN_H
#define DIM_PLAN_H

#include "engine/dim_paths.h"

/* Set `wanted` of each, if so many rays are left. Those that can reach DIM_GOAL are `planned`; the
 * others get as the rest allows, all the same share of their light, in steps of a fiftieth. Where
 * there are none those that are planned are made surer by it. Each has a first look. */
void dim_plan(struct dim_faces *d, double rays);

#endif
