/* visibility_error.h - term: sigma_V, the standard deviation of the visibility as it is known.
 * Dimensionless, in [0, 1/2].
 *
 * sqrt(v (1 - v) / N), N the rays of its level, as if they were independent (a net does better).
 * Where all rays agree, v = 0 or 1, that formula knows of no error: 1/N stands in its place.
 * Extinction counts as one ray; nothing known: 1/2, the most that a quantity in [0, 1] can have.
 * exact: 0. It casts no ray of its own, and follows the visibility when that becomes better known.
 * [Turbet & Sillion; 1/N derived here]
 * Fails: it is statistical, no bound; a visibility weighted by what it would carry has fewer
 * effective rays.
 * SPDX-License-Identifier: MIT */
#ifndef TERM_VISIBILITY_ERROR_H
#define TERM_VISIBILITY_ERROR_H

#include "discussion.h"
#include "terms/visibility.h"

static inline double visibility_error_of(double v, enum visibility_level level)
{
    double rays = visibility_rays_of(level);
    if (level == VISIBILITY_EXACT)
        return 0;
    if (level == VISIBILITY_ABSENT)
        return 0.5;
    if (v <= 0 || v >= 1)
        return rays > 2 ? 1 / rays : 0.5;
    return sqrt(v * (1 - v) / rays);
}

TOOL double term_visibility_error(struct discussion *d)
{
    d->terms.visibility_error =
        visibility_error_of(d->terms.visibility, (enum visibility_level)d->terms.visibility_level);
    d->terms.visibility_error_level = VISIBILITY_ERROR_PRESENT;
    return d->terms.visibility_error;
}

#endif
