/* bracket.h - question: how far may this link keep the lower and the upper solution apart? W.
 *
 * Solve twice over the same links, once for the least radiosity that they allow, L, and once for
 * the most, U: the truth is between. A link's F V over the points of the receiver is between k and
 * K: F by its bounds, V = 1 where a shaft proves it, 0 where one proves that, else anything from 0
 * to 1. From U - L = K U - k L = (K - k) L + K (U - L) follows that
 *     impact A_r rho_r ((K - k) L_s + K gap_s)
 * is what the link itself does to the area between the two: (K - k) L by what is not known of F and
 * V, and, by taking the emitter as a whole, how much nearer the two come below it where its parts
 * are taken one by one. The rest of U - L at the emitter came over links to it, and is theirs. What
 * is left of it is reflected on: impact. The larger part says who is to be split.
 * `lower` and `gap` are the emitter's, which only a solve can tell: give it emitter.lower and
 * emitter.gap, that the engine asks for (engine/bracket.c); and where that is more, for gap
 * emitter.spread, by which the emitter's parts differ in the usual solution.
 * [Lischinski, Smits, Greenberg 1994, lower and upper solutions and the effect of a link on their
 * difference; this form of it: derived here]
 * Fails: half shadow counts in full, however much of V is known by rays; where elements touch F
 * ranges over the same values at every size, and only A_r brings that to an end.
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_BRACKET_H
#define TOOL_BRACKET_H

#include "discussion.h"
#include "terms/form_factor_range.h"

/* What a shaft has proved of the visibility at every point; else it is between 0 and 1. */
static inline void bracket_visibility(double v, unsigned char level, double range[2])
{
    int exact = level == VISIBILITY_EXACT;
    range[0] = exact && v >= 1 ? 1 : 0;
    range[1] = exact && v <= 0 ? 0 : 1;
}

TOOL enum bracket_answer tool_bracket(struct discussion *d, double watts, double lower, double gap,
                                      double impact)
{
    const struct element *r = d->receiver;
    double scale = impact * r->area * r->reflectance, v[2];
    bracket_visibility(d->terms.visibility, d->terms.visibility_level, v);
    if (!(scale * v[1] * (lower + gap) > watts)) /* F <= 1 */
        return BRACKET_SMALL;
    const double *f = term_form_factor_range(d, FORM_FACTOR_RANGE_BOUNDED);
    double by_r = scale * (v[1] * f[1] - v[0] * f[0]) * lower;
    double by_s = scale * v[1] * f[1] * gap;
    if (!(by_r + by_s > watts))
        return BRACKET_SMALL;
    return by_r >= by_s ? BRACKET_RECEIVER : BRACKET_EMITTER;
}

#endif
