/* mates.h - who stands across each edge of what stands in shafts.
 * SPDX-License-Identifier: MIT */
#ifndef MATES_H
#define MATES_H

#include "hierarchy/hierarchy.h"

enum { NO_MATE = -1 };

struct mates {
    /* [built]: across the edge from corner i to the next: twice the element's index, 1 more when it
     * runs along the edge the same way round, so that the fronts of the two are on different sides;
     * NO_MATE: nobody, or not known who of several */
    int64_t (*of)[4];
};

/* Of a hierarchy with groups. Returns 0, or -1 when out of memory; close is fine then too. */
int mates_open(struct mates *mates, const struct hierarchy *h);
void mates_close(struct mates *mates);

#endif
