/* power_gap.h - question: may the power that this link brings be distributed wrongly by more than
 * `watts`? W.
 *
 * The link gives the receiver rho_r F V B_s all over, where there is rho_r B_s F(x) V(x). Over the
 * whole receiver
 *     by_r = rho_r A_r B_s (V dF + F dV),   dF = (F_max - F_min)/2 sampled,   dV = 2 v (1 - v)
 * is how far the two are apart: dV is the mean deviation of a visibility that is 0 or 1 at each
 * point [Sillion and Drettakis 1995, appendix A]. The power of the receiver is right all the same,
 * since that is no more than the mean; but what r sends on comes from the wrong part of it: a floor
 * that is dark at the foot of a block, and bright on the mean, lights the block's shaded side (in
 * the Cornell box to twice its light). With e_s the spread of B over the emitter,
 *     by_s = rho_r A_r V F e_s / 2
 * is the same for the emitter, times 16 in half shadow: what a blocker hides of an emitter is as a
 * rule what it keeps the light from, so that these errors have one sign, and add where the others
 * cancel. Visibility unknown: V = 1, dV = 0. The larger part says who is to be split. Both shrink
 * with A_r at the latest, so whatever touches or lies in half shadow comes to an end.
 * [D: derived here, in the L1 norm of Arvo, Torrance and Smits 1994]
 * Fails: sampled ranges; e_s knows only what has been split so far; dV is too much where half
 * shadow is soft.
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_POWER_GAP_H
#define TOOL_POWER_GAP_H

#include "discussion.h"
#include "kernel/constants.h"
#include "terms/form_factor.h"
#include "terms/form_factor_range.h"

TOOL enum power_gap_answer tool_power_gap(struct discussion *d, double watts)
{
    const struct element *r = d->receiver, *s = d->emitter;
    double v = 1, scale = r->reflectance * r->area;
    if (d->terms.visibility_level > VISIBILITY_ABSENT)
        v = d->terms.visibility;
    if (!(scale * (s->radiosity + POWER_GAP_ALIGNED * s->spread) > watts)) /* F <= 1 */
        return POWER_GAP_SMALL;
    double f = term_form_factor(d, FORM_FACTOR_POLYGON);
    /* dF is of the size of F */
    if (!(scale * (s->radiosity + POWER_GAP_ALIGNED * s->spread) * f > 0.5 * watts))
        return POWER_GAP_SMALL;
    const double *range = term_form_factor_range(d, FORM_FACTOR_RANGE_SAMPLED);
    double by_r = scale * s->radiosity * (0.5 * v * (range[1] - range[0]) + 2 * v * (1 - v) * f);
    double by_s = scale * s->spread * 0.5 * v * f * (v < 1 ? POWER_GAP_ALIGNED : 1);
    if (!(by_r + by_s > watts))
        return POWER_GAP_SMALL;
    return by_r >= by_s ? POWER_GAP_RECEIVER : POWER_GAP_EMITTER;
}

#endif
