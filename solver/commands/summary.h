/* summary.h - what a solve did: a page for people, an object for programs.
 * SPDX-License-Identifier: MIT */
#ifndef SUMMARY_H
#define SUMMARY_H

#include <jansson.h>
#include "options.h"
#include "oracle/refiner.h"
#include "engine/solve.h"

void summary_print(const struct options *options, const struct solve *s, const struct refiner *refiner, double output_seconds);

/* The caller owns it; NULL when out of memory. */
json_t *summary_json(const struct options *options, const struct solve *s, const struct refiner *refiner, double output_seconds);

#endif
