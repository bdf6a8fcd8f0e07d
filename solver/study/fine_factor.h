/* fine_factor.h - the form factor of two polygons by area integration, what the contour integral is
 * measured against.
 * SPDX-License-Identifier: MIT */
#ifndef FINE_FACTOR_H
#define FINE_FACTOR_H

#include "discussion.h"

/* F_rs, nothing between the two; *doubt: what the integration may have left, by its own measure. */
double fine_factor(const struct element *r, const struct element *s, double *doubt);

#endif
