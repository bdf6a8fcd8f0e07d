/* unevenness.h - how wrong it may be to send V times the mean of B, for the mean of V B (W/m2).
 *
 * The two differ by cov(V, B) over the emitter. V lies in [0, 1], so |cov| is at most half the mean
 * of |B - its mean|, reached where V is 1 on all that is brighter than the mean and 0 on the rest;
 * and at most the hidden share times the spread of B, or the seen share. Of the shares N rays know
 * no more than 1/N beyond what they found. Where a shaft has proved that all is seen nothing can be
 * wrong. [derived here; the hidden bright spot of a lamp close under a ceiling is the case that
 * fails without it]
 * Fails: shares by few rays are statistical.
 * SPDX-License-Identifier: MIT */
#ifndef TERM_UNEVENNESS_H
#define TERM_UNEVENNESS_H

#include "discussion.h"
#include "terms/visibility.h"

/* Of a pair whose visibility is known. */
static inline double unevenness(const struct discussion *d)
{
    const struct element *s = d->emitter;
    double v = d->terms.visibility;
    if (d->terms.visibility_level == VISIBILITY_EXACT && (v <= 0 || v >= 1))
        return 0;
    double share = v < 0.5 ? v : 1 - v;
    if (d->terms.visibility_level != VISIBILITY_EXACT)
        share += 1.0 / visibility_rays_of((enum visibility_level)d->terms.visibility_level);
    return share * s->spread < s->deviation ? share * s->spread : s->deviation;
}

#endif
