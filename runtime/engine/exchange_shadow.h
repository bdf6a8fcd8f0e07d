/* exchange_shadow.h - two flat groups of faces in each other's half shadow: what each pair sees.
 * SPDX-License-Identifier: MIT */
#ifndef EXCHANGE_SHADOW_H
#define EXCHANGE_SHADOW_H

#include "engine/exchange_clear.h"
#include "engine/exchange_sight.h"

/* One thread's room, for the faces of a tile's side. */
struct shadow_scratch {
    struct shadow_cell *cells;
    struct shadow_sight *sights;
};
int shadow_scratch_open(struct shadow_scratch *scratch);
void shadow_scratch_close(struct shadow_scratch *scratch);

/* values[rows][columns] are what pairs would exchange if nothing stood between; on return, what
 * they do past the faces of the list. Returns the largest error estimated, as a share of the
 * smaller area. */
double shadow_block(const struct exchange_pair *pair, const struct blockers *list,
                    struct shadow_scratch *scratch, struct sight_scratch *looking, double *values);

#endif
