/* worst.h - question: is what this link does wrong, times what comes of it, above `watts`? W.
 *
 * The error of the link is what it puts into the wrong place on the receiver, or takes from the
 * wrong place on the emitter, as in power_gap.h:
 *     by_r = rho_r A_r B_s (V dF + F dV),  by_s = rho_r A_r V F e_s / 2,
 * dF = (F_max - F_min)/2 over samples and the mean (which is far above all of them where a lamp
 * hangs just below a ceiling), dV = 2 v (1 - v), e_s the spread of B over the emitter. by_s counts
 * 16 times unless V is proved to be 1 at all points, for what a blocker hides of an emitter is as a
 * rule what it keeps the light from, and rays that all pass may have missed it. So too v is not
 * what N rays said but (hits + 1) / (N + 2), Laplace's rule: a pair that seems hidden, or clear, is
 * wrong by what rays may have missed, and only a shaft makes that 0.
 *
 * Of a watt that is wrong at the receiver, impact watts are wrong at all surfaces, or in the view:
 * the adjoint solution (engine/importance.c). Error times impact is the derivative of the whole
 * error by the link, so that links compare: given scene.rank, a threshold which the engine sets
 * before each pass so that it is exceeded by a share of all links (engine/ranking.c), a graph
 * refines the worst first, wherever they are.
 * [Lischinski, Smits, Greenberg 1994, for error times impact; Holzschuch, Sillion, Drettakis 1994
 * for refinement in the order of what it is worth; Laplace's rule here: derived here]
 * Fails: sampled ranges; e_s knows only what has been split so far.
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_WORST_H
#define TOOL_WORST_H

#include "discussion.h"
#include "kernel/constants.h"
#include "terms/form_factor.h"
#include "terms/form_factor_range.h"
#include "terms/visibility.h"

/* Error times impact of a pair of surfaces, by the receiver and by the emitter (W). */
TOOL void worst_parts(struct discussion *d, double by[2])
{
    const struct element *r = d->receiver, *s = d->emitter;
    double v = 1, scale = r->importance * d->host->impact * r->reflectance * r->area;
    int proved = d->terms.visibility_level == VISIBILITY_EXACT;
    if (d->terms.visibility_level > VISIBILITY_ABSENT)
        v = d->terms.visibility;
    if (d->terms.visibility_level >= VISIBILITY_RAYS_1 && !proved) {
        double rays = visibility_rays_of((enum visibility_level)d->terms.visibility_level);
        v = (v * rays + 1) / (rays + 2);
    }
    double f = term_form_factor(d, FORM_FACTOR_POLYGON);
    const double *range = term_form_factor_range(d, FORM_FACTOR_RANGE_SAMPLED);
    double low = range[0] < f ? range[0] : f, high = range[1] > f ? range[1] : f;
    by[0] = scale * s->radiosity * (0.5 * v * (high - low) + 2 * v * (1 - v) * f);
    by[1] = scale * s->spread * 0.5 * v * f * (v < 1 ? POWER_GAP_ALIGNED : 1);
}

TOOL enum worst_answer tool_worst(struct discussion *d, double watts)
{
    double by[2];
    worst_parts(d, by);
    if (!(by[0] + by[1] > watts))
        return WORST_SMALL;
    return by[0] >= by[1] ? WORST_RECEIVER : WORST_EMITTER;
}

#endif
