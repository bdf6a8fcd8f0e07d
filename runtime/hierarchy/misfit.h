/* misfit.h - how far surfaces that ought to meet are off each other.
 * SPDX-License-Identifier: MIT */
#ifndef MISFIT_H
#define MISFIT_H

#include "hierarchy/bodies.h"

/* The largest distance (m) by which corners in one place, faces of one flat group, the corners of a
 * bent quad, or bodies and what they stand on miss each other, of a hierarchy with groups. Returns
 * 0, or -1 when out of memory. */
int misfit_find(const struct hierarchy *h, const struct bodies *bodies, double *misfit);

#endif
