/* linear_gap.h - question: by how much may the irradiance that the link brings miss the best linear
 * function over the receiver (W/m2), by F over the receiver, or by B over the emitter? If by more
 * than the larger of `absolute` (W/m2) and `relative` times the scene's mean irradiance: who is to
 * be split? Approximate: F is sampled. What all links of the receiver miss `together` (W/m2;
 * engine/bends.c measures it) tells whether others make up for this one: where it is not above that
 * either, nobody is split for F (balanced).
 *
 * Receiver: F at its corners and centre holds a linear part, which linear elements take up, and
 * what is left: the twist (F0 - F1 + F2 - F3)/4 of a quad and the bulge, F at the centre less the
 * corners' mean, of which 2/3 is left at the centre. A peak between these points shows in F's mean
 * over the receiver, which is computed otherwise: what it differs from Simpson's mean of the
 * samples is light in the wrong place. Emitter: to second order in its size over the distance the
 * kernel is linear over it, and so is B but for its deviation. [Gortler et al. 1993 and Lischinski
 * et al. 1994 for constants; for linear elements derived here] Fails: sampled; B's own slope is
 * counted as deviation.
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_LINEAR_GAP_H
#define TOOL_LINEAR_GAP_H

#include "discussion.h"
#include "kernel/corner_factors.h"
#include "kernel/threshold.h"
#include "terms/axis.h"
#include "terms/form_factor.h"

/* What is left of F over r beside its best linear function. */
OUTLINE double linear_gap_bend(const struct element *r, const struct element *s, double mean)
{
    double f[5];
    (void)corner_factors(r, s, f);
    return corner_bend(f, r->vertices, mean);
}

TOOL enum linear_gap_answer tool_linear_gap(struct discussion *d, double absolute, double relative,
                                            double together)
{
    const struct element *r = d->receiver, *s = d->emitter;
    double limit = threshold(absolute, relative, d->host->irradiance), v = 1;
    if (d->terms.visibility_level > VISIBILITY_ABSENT)
        v = d->terms.visibility;
    double f = v * term_form_factor(d, FORM_FACTOR_POLYGON);
    const double *axis = term_axis(d);
    double square = dot3(axis, axis), size = s->radius * s->radius;
    double by_s = f * s->deviation * (size < square ? size / square : 1);
    double by_r = s->radiosity > limit
                      ? v * s->radiosity * linear_gap_bend(r, s, d->terms.form_factor)
                      : 0; /* F <= 1 */
    if (!(by_r > limit) && !(by_s > limit))
        return LINEAR_GAP_SMALL;
    if (by_r > limit && together > limit && by_r >= by_s)
        return LINEAR_GAP_RECEIVER;
    return by_s > limit ? LINEAR_GAP_EMITTER : LINEAR_GAP_BALANCED;
}

#endif
