/* dim_plan.h - how many paths each dim polygon gets.
 *
 * So many that 1 / (1 / s^2 + n / v), v the variance of one, is the square of DIM_GOAL of its
 * light. Few tell first how noisy they are and how much light there is. Then polygons get what they
 * need, the cheapest first, so that few are left wrong. What remains makes the others equally
 * sure; and as much again may make those surer that can be, so that of many none is wrong by
 * chance.
 * Small polygons are all to be equally sure: there are too many to get some of them right and leave
 * the others as they are. [derived here]
 * SPDX-License-Identifier: MIT */
#ifndef DIM_PLAN_H
#define DIM_PLAN_H

#include "engine/dim_paths.h"

/* Set `wanted` of each, if so many rays are left, and `most` with those that make some surer. Those
 * that can reach DIM_GOAL are `planned`; they and the others get as the rest allows, all the same
 * share of their light, in steps of a fiftieth. Each has a first look. */
void dim_plan(struct dim_faces *d, double rays, double most);

/* Set `wanted` of each that is not sure to what makes it so, by a margin. Returns how many rays
 * that takes; INFINITY where paths are no way to it: they miss something, or all light is known too
 * little. */
double dim_plan_rest(struct dim_faces *d);

#endif
