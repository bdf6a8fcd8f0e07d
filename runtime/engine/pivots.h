/* pivots.h - the pivots of a separable link: where each side sees the other's light come from, or
 * go to.
 * SPDX-License-Identifier: MIT */
#ifndef PIVOTS_H
#define PIVOTS_H

#include "engine/separable_faces.h"

/* Set *r and *s for the elements `receiver` and `emitter`, whose faces the sides are. Returns pi
 * k(r, s) (1/unit^2), or 0 where nothing passes; then *r and *s mean nothing. */
float find_pivots(struct pivot *r, struct pivot *s, const struct element *receiver,
                  const struct element *emitter, const struct separable_side *of_r,
                  const struct separable_side *of_s);

#endif
