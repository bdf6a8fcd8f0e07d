/* stability_known.h - closed forms with a shadow in them, beside those of closed_forms.h.
 * Derived from B-4 there: a rectangle that hides another leaves the source less the shadow's
 * section with it.
 * SPDX-License-Identifier: MIT */
#ifndef STABILITY_KNOWN_H
#define STABILITY_KNOWN_H

#include "study/closed_forms.h"

/* From a point with a horizontal surface to the rectangle [x0, x1] x [y0, y1] parallel to it at
 * height h over it; coordinates from the point. */
double known_point(double x0, double x1, double y0, double y1, double h);

/* The same with a blocking rectangle of corners `blocker` (as x0, x1, y0, y1) at height z < h. */
double known_penumbra(const double source[4], double h, const double blocker[4], double z);

#endif
