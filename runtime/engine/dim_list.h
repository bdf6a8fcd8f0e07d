/* dim_list.h - which polygons are asked: those of a size, or groups of small ones, that reflect in
 * a band that is lit and are not covered by what stands on them; and the faces of each.
 * SPDX-License-Identifier: MIT */
#ifndef DIM_LIST_H
#define DIM_LIST_H

#include "engine/dim_paths.h"

/* By d->solve, d->tracer and d->size: `lit` and the members from `part` to `until`, no more than
 * `most` polygons, the largest. Returns 0, or -1 when out of memory, on any rank; dim_list_close in
 * either case. */
int dim_list_open(struct dim_faces *d, uint32_t most);
void dim_list_close(struct dim_faces *d);

/* May the face reflect any light? Not what is green, where all lamps are red. */
int dim_list_reflects(const struct dim_faces *d, uint32_t face);

#endif
