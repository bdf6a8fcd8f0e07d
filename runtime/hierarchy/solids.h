/* solids.h - convex solids of any number of faces: which of them a face is part of.
 * SPDX-License-Identifier: MIT */
#ifndef SOLIDS_H
#define SOLIDS_H

#include "hierarchy/mates.h"

struct solids {
    uint32_t *of; /* [built]: 1 more than the solid that an element is a face of; 0: of none */
    uint32_t count;
};

/* Of a hierarchy with groups. Returns 0, or -1 when out of memory; close is fine then too. */
int solids_open(struct solids *solids, const struct hierarchy *h, const struct mates *mates);
void solids_close(struct solids *solids);

#endif
