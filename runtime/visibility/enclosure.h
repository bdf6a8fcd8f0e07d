/* enclosure.h - is the scene closed?
 * SPDX-License-Identifier: MIT */
#ifndef ENCLOSURE_H
#define ENCLOSURE_H

#include "visibility/rays.h"

/* 1 when light that walks through the scene from the faces with exitance[face] > 0 never leaves it
 * nor meets the black back of a one-sided face, else 0; 0 when none emits. *steps: the rays that
 * say so. */
int enclosure_decide(const struct rays *rays, const struct hierarchy *h, const double *exitance,
                     int threads, uint64_t *steps);

#endif
