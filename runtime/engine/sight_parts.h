/* sight_parts.h - parts of a face from which another is looked at.
 * SPDX-License-Identifier: MIT */
#ifndef SIGHT_PARTS_H
#define SIGHT_PARTS_H

#include "discussion.h"

enum { SIGHT_QUARTERS = 4 };

/* The part of e in front of a plane; corners within `flat` (m) of it lie in it. Where rounding puts
 * the ends of a shared edge on either side, a clip at no distance would add a corner on the edge.
 * Returns 1 when that is all of it; out->n is 0 when none is. */
int sight_part_in_front(struct polygon *out, const struct element *e, const struct element *plane,
                        double flat);

/* A piece of e with these corners, 3 or 4. */
void sight_piece_make(struct element *piece, const struct element *e, const double (*v)[3], int n);

/* Quarter q of a piece, cut near the middles of its sides, and nowhere the same: where shades
 * repeat, as those of slats do, quarters of one size would all be off alike. */
void sight_quarter_make(struct element *out, const struct element *e, int q);

#endif
