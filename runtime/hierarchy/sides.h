/* sides.h - which sides of faces bound one space, as far as edges tell.
 * SPDX-License-Identifier: MIT */
#ifndef SIDES_H
#define SIDES_H

#include "hierarchy/hierarchy.h"
#include "util/ranks.h"

/* Of a face that is not itself a far side: 2 f its front, 2 f + 1 what lies behind it. The side
 * `far` has no face: it is what rays that leave the scene get to. */
struct sides {
    uint32_t *up; /* [far + 1]: another of the same space; itself at the root */
    uint32_t far;
    /* [far]: the rim of another face lies in it, so parts of it may bound several spaces; or too
     * many stand along its own */
    _Atomic uint8_t *touched;
};

/* Of a hierarchy without groups, on so many threads; precision: of coordinates, relative (scene.h).
 * Of several ranks each looks at its part of the edges, and all have what all have found. Returns
 * 0, or -1 on all when any is out of memory; close is fine then too. */
int sides_open(struct sides *sides, const struct hierarchy *h, double precision,
               struct ranks *ranks, int threads);
void sides_close(struct sides *sides);

/* What stands for the space that a side bounds. */
uint32_t sides_space(struct sides *sides, uint32_t side);
void sides_join(struct sides *sides, uint32_t a, uint32_t b);

/* The side that a listed face is. */
static inline uint32_t sides_of(const struct hierarchy *h, uint32_t face)
{
    return h->faces[face].back ? 2 * face - 1 : 2 * face;
}

#endif
