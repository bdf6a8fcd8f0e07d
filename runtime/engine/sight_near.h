/* sight_near.h - how much a piece's points misjudge faces near it, which stand in its way.
 * SPDX-License-Identifier: MIT */
#ifndef SIGHT_NEAR_H
#define SIGHT_NEAR_H

#include "engine/exchange_tree.h"

/* What is known of pieces and faces. A face is looked at by all others, cut into the same pieces
 * past the same faces: most of what is asked was asked before. So many places; chosen: 1.5 MB. */
enum { SIGHT_KNOWN = 1 << 16 };
struct sight_known {
    struct sight_known_place {
        uint64_t key; /* of the piece's corners, the face and what is asked; 0: nothing yet */
        double value[2];
    } place[SIGHT_KNOWN];
};

/* Of what a piece exchanges with each of the faces that is near it, with nothing between: how far
 * the points inside of it are off, in all; *sum: what they say of these (m2). */
double sight_near(const struct element *piece, const struct exchange_tree *tree,
                  const uint32_t *faces, int count, struct sight_known *known, double *sum);

/* What a face and e exchange with nothing between, whichever of its sides the face turns to e
 * (m2). `face`: an element of the tree; e: one, or a piece of one. */
double sight_exchange_through(const struct exchange_tree *tree, uint32_t face,
                              const struct element *e, struct sight_known *known);

#endif
