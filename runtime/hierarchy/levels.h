/* levels.h - the elements that have children, level by level, so that threads may share a level: of
 * faces and their parts, those as many splits below the face; of clusters there is one, to be gone
 * through in order.
 * SPDX-License-Identifier: MIT */
#ifndef LEVELS_H
#define LEVELS_H

#include "hierarchy/hierarchy.h"

enum { LEVELS = UINT8_MAX + 2 }; /* clusters, then splits from 0 on */

struct levels {
    uint32_t *parent;          /* in the order of elements within each level */
    uint32_t from[LEVELS + 1]; /* of each level in `parent`; of one more, how many there are */
};

/* Of the hierarchy as it is now. Returns 0, or -1 when out of memory. */
int levels_open(struct levels *l, const struct hierarchy *h);
void levels_close(struct levels *l);

#endif
