/* tail_error.h - the error that all but a thousandth of the area is below.
 * SPDX-License-Identifier: MIT */
#ifndef TAIL_ERROR_H
#define TAIL_ERROR_H

#include "engine/element_light.h"
#include "particles/particles.h"

/* The sum over bands of |B~ - B| that 99.9 % of the uncovered, reflecting area is below, over the
 * area mean of B~ - E, the light reflected; B~ the light, slopes and all. By about so many rays,
 * which are added to *rays; below some 100,000 candidates are chosen by chance. Another stream,
 * another answer; threads do not show. All zero where nothing shines or reflects. watch: NULL, or
 * asked. Returns 0, or -1 when out of memory or stopped. */
int tail_error_measure(const struct solve *s, const struct tracer *t,
                       const struct element_light *light, uint64_t budget, uint64_t stream,
                       const struct watch *watch, struct RadMeasure *tail, uint64_t *rays);

#endif
