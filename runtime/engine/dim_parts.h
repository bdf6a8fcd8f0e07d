/* dim_parts.h - small faces gathered into parts as large as a large polygon.
 * SPDX-License-Identifier: MIT */
#ifndef DIM_PARTS_H
#define DIM_PARTS_H

#include "particles/tracer.h"

/* part[face]: at first the polygon it is of, below *count; area[polygon]: what reflects of it (m2).
 * Faces of polygons no larger than `large` (m2) that lie near each other and look the same way get
 * the same new number, from *count on, where they are more than `large` together, and at most about
 * twice that; others keep theirs. *count is raised. Returns 0, or -1 when out of memory. */
int dim_parts_find(const struct tracer *t, const double *area, double large, uint32_t *part,
                   uint32_t *count);

#endif
