/* sight_near.h - how much a piece's points misjudge faces near it, which stand in its way.
 * SPDX-License-Identifier: MIT */
#ifndef SIGHT_NEAR_H
#define SIGHT_NEAR_H

#include "engine/exchange_tree.h"

/* Of what a piece exchanges with each of the faces that is near it, with nothing between: how far
 * the points inside of it are off, in all; *sum: what they say of these (m2). */
double sight_near(const struct element *piece, const struct exchange_tree *tree,
                  const uint32_t *faces, int count, double *sum);

/* What a face and e exchange with nothing between, whichever of its sides the face turns to e
 * (m2). */
double sight_exchange_through(const struct element *face, const struct element *e);

#endif
