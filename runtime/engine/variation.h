/* variation.h - what constants on leaves leave of x, by how it steps from leaf to leaf.
 * SPDX-License-Identifier: MIT */
#ifndef VARIATION_H
#define VARIATION_H

#include "engine/transport.h"

/* sum A d / sum A x over uncovered leaves, all bands; d of a leaf is the largest |x - its parent's
 * mean| among the parent's children. */
double variation_of(const struct light_operator *op, const struct transport *x);

/* The relative L1 error that iteration may leave beside such a variation. */
double variation_tolerance(double variation);

#endif
