/* standing.h - may a solid stand on a part of a surface, and not on the rest?
 * SPDX-License-Identifier: MIT */
#ifndef STANDING_H
#define STANDING_H

#include "hierarchy/hierarchy.h"

/* 0: what is inside a solid just in front of e (a face or a part of one) is all of e or nothing of
 * it, but for solids that hang open above it, higher than STANDING_GAP of its radius; off (m): how
 * far from e points are asked, and what rounding may do. Thread-safe. */
int standing_may(const struct hierarchy *h, const struct element *e, double off);

/* 0: nothing reaches into the lowest 2 off above what of e is farther than off from its border:
 * what is nearer there than off to e, along it, is on the same side of all faces. Thread-safe. */
int standing_within(const struct hierarchy *h, const struct element *e, double off);

#endif
