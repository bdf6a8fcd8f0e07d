/* sight_missed.h - how much a piece may lose to faces that none of its points sees in its way.
 * SPDX-License-Identifier: MIT */
#ifndef SIGHT_MISSED_H
#define SIGHT_MISSED_H

#include "engine/face_rule.h"
#include "engine/sight_near.h"
#include "engine/sight_pieces.h"

/* The points of the rules inside of so many pieces, where rays from them start, and how far that is
 * over the plane. */
enum { SIGHT_EYED = 5 };
struct sight_eyes {
    const struct sight *sight;
    double up;
    int count;
    int enough; /* a shade that so many see is not missed */
    double from[SIGHT_EYED * FACE_RULE][3], height[SIGHT_EYED * FACE_RULE];
};

/* up: how far off their piece points look from (m); enough: so many that see a shade tell it. sight
 * is borrowed. */
void sight_eyes_open(struct sight_eyes *eyes, const struct sight *sight, double up, int enough);
void sight_eyes_add(struct sight_eyes *eyes, const struct element *piece);

/* At most what of the exchange of a piece and the polygon `to`, which the eyes' sight was opened
 * for, passes through those of the faces that throw a shade on fewer than enough of the points
 * (m2); no more than `most` is told. */
double sight_missed(const struct sight_eyes *eyes, const struct element *piece,
                    const struct element *to, const struct exchange_tree *tree,
                    const uint32_t *faces, int count, struct sight_known *known, double most);

#endif
