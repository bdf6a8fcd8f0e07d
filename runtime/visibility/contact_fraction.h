/* contact_fraction.h - the share of a surface that solids stand on, as a table leg on the floor.
 * SPDX-License-Identifier: MIT */
#ifndef CONTACT_FRACTION_H
#define CONTACT_FRACTION_H

#include "hierarchy/hierarchy.h"
#include "visibility/rays.h"

/* Share of e's area in [0, 1], in steps of 1/16; e is of the hierarchy. Thread-safe. */
double contact_fraction(const struct rays *rays, const struct hierarchy *h,
                        const struct element *e);

/* Does a solid stand on the point p (m) of e, ray_offset in front of it? By CONTACT_RAYS rays or
 * fewer. Thread-safe. */
int contact_covers(const struct rays *rays, const struct element *e, const double p[3]);

#endif
