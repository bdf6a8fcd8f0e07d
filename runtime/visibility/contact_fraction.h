/* contact_fraction.h - the share of a surface that solids stand on, as a table leg on the floor.
 * SPDX-License-Identifier: MIT */
#ifndef CONTACT_FRACTION_H
#define CONTACT_FRACTION_H

#include "visibility/rays.h"

/* Share of e's area in [0, 1], in steps of 1/16. Thread-safe. */
double contact_fraction(const struct rays *rays, const struct element *e);

#endif
