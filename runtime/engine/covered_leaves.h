/* covered_leaves.h - leaves made small along the edges of what stands on them.
 * SPDX-License-Identifier: MIT */
#ifndef COVERED_LEAVES_H
#define COVERED_LEAVES_H

#include "engine/solve.h"

/* Split the leaves of a linear solution that solids cover in part until none of these is larger
 * than COVERED_SHARE of the scene's area, and those beside what is split until none is longer than
 * twice its neighbour. What links say is the same function as before (detail.h). All ranks make the
 * same ones: quarters are not each rank's own yet. Returns 0, or -1 when out of memory. */
int covered_leaves(struct solve *s);

#endif
