/* relative_error.h - question: may the radiosity that this link adds be wrong by more than a share
 * of the scene's light? W/m2.
 *
 * err = rho_r V dF B_s, dF the largest deviation of F from its mean over the receiver (sampled), V
 * the visibility where it is known and 1 where not; in a colour the largest band stands for the
 * largest err. The limit is the larger of `exitance` times the scene's largest exitance (rpkCpp's
 * "radiance norm": its radiances are these over pi), and of `power` times mean radiosity times
 * A_scene / A_r (its "power norm", which takes the strongest emitter's power where this takes that
 * of all surfaces, since that is what the host knows). [rpkCpp, hierarchic refinement]
 * Fails: one tiny intense lamp raises everyone's limit; what sampling misses; half shadow counts
 * only by its mean.
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_RELATIVE_ERROR_H
#define TOOL_RELATIVE_ERROR_H

#include "discussion.h"
#include "terms/form_factor.h"
#include "terms/form_factor_range.h"

TOOL enum relative_error_answer tool_relative_error(struct discussion *d, double exitance,
                                                    double power)
{
    const struct host *h = d->host;
    double limit = exitance * h->exitance,
           by_power = power * h->radiosity * h->area / d->receiver->area;
    double scale = d->receiver->reflectance * d->emitter->radiosity;
    if (by_power > limit)
        limit = by_power;
    if (d->terms.visibility_level > VISIBILITY_ABSENT)
        scale *= d->terms.visibility;
    if (!(scale > limit)) /* dF <= 1 */
        return RELATIVE_ERROR_BELOW;
    const double *range = term_form_factor_range(d, FORM_FACTOR_RANGE_SAMPLED);
    double f = term_form_factor(d, FORM_FACTOR_POLYGON);
    double df = range[1] - f > f - range[0] ? range[1] - f : f - range[0];
    return scale * df > limit ? RELATIVE_ERROR_ABOVE : RELATIVE_ERROR_BELOW;
}

#endif
