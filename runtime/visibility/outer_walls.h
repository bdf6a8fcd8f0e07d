/* outer_walls.h - faces that have the whole scene in front of them, and so never stand in the way.
 * SPDX-License-Identifier: MIT */
#ifndef OUTER_WALLS_H
#define OUTER_WALLS_H

#include "hierarchy/hierarchy.h"

/* Of a hierarchy with groups: makes `outer` of it. `offset`: how far ends of shafts are off their
 * surfaces (m). Returns 0, or -1 when out of memory. */
int outer_walls_find(struct hierarchy *h, double offset);

#endif
