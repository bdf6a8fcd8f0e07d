/* leaf_at.h - which leaf of a face holds a point, and what each of its corners counts for there.
 * SPDX-License-Identifier: MIT */
#ifndef LEAF_AT_H
#define LEAF_AT_H

#include "output/solution.h"

/* Weights of the leaf's corners add to 1: bilinear in quads, linear in triangles. A point outside
 * the face counts as the nearest of its border, nearly. Returns the leaf. */
uint32_t leaf_at(const struct solution *solution, uint32_t face, const double point[3],
                 double weight[4]);

#endif
