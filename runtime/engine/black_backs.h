/* black_backs.h - how much light ends on black backs, by what particles have counted.
 * SPDX-License-Identifier: MIT */
#ifndef BLACK_BACKS_H
#define BLACK_BACKS_H

#include "hierarchy/scene.h"
#include "particles/particles.h"

struct black_backs {
    double share;      /* of what is emitted */
    uint32_t most;     /* the polygon whose back takes most; input_count: none takes any */
    double most_share; /* of what all backs take */
};

/* Of a tally whose counts are added, on all ranks alike. Paths from polygons see no light that
 * ends: then none. Returns 0, or -1 when out of memory. */
int black_backs_find(struct black_backs *b, const struct scene *scene, const struct tally *tally,
                     struct ranks *ranks);

#endif
