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

/* Of a tally whose counts are added. Paths from polygons see no light that ends: then nothing. */
struct black_backs black_backs_met(const struct scene *scene, const struct tally *tally);

#endif
