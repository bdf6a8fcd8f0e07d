/* error_causes.h - which light the links bring wrongly, and why.
 * SPDX-License-Identifier: MIT */
#ifndef ERROR_CAUSES_H
#define ERROR_CAUSES_H

#include "engine/solve.h"

/* Hold what the links bring against what about so many rays find of the same radiosities, with
 * random numbers of a stream. What the operator's separable links have sent last is written anew.
 * All of the report but `seconds` is set. Returns 0, or -1 when out of memory or cancelled. */
int error_causes_find(struct solve *s, uint64_t rays, uint64_t stream,
                      struct RadCausesReport *report);

#endif
