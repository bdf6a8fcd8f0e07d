/* transfer_noise.h - question: may the rays' noise falsify the irradiance that this link brings,
 * F B sigma_V (W/m2), by more than the larger of `absolute` (W/m2) and `relative` times the scene's
 * mean irradiance?
 *
 * sigma_V as terms/visibility_error.h has it. The cure is rays, not subdivision: asked after 4
 * rays, after 16 and so on, it is a test in steps that ends as soon as more rays would change
 * nothing that matters. [sequential analysis, Wald 1945; derived here] Fails: it is statistical; of
 * a blocker that no ray meets it fears 1/N.
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_TRANSFER_NOISE_H
#define TOOL_TRANSFER_NOISE_H

#include "discussion.h"
#include "kernel/threshold.h"
#include "terms/form_factor.h"
#include "terms/visibility_error.h"

TOOL enum transfer_noise_answer tool_transfer_noise(struct discussion *d, double absolute,
                                                    double relative)
{
    double limit = threshold(absolute, relative, d->host->irradiance);
    return d->emitter->radiosity * term_form_factor(d, FORM_FACTOR_DISC) * term_visibility_error(d)
                   > limit
               ? TRANSFER_NOISE_LARGE
               : TRANSFER_NOISE_SMALL;
}

#endif
