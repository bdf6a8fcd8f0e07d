/* power_noise.h - question: may the rays' noise falsify the power that this link brings by more
 * than `watts`? W.
 *
 * rho_r A_r F B_s sigma_V, sigma_V the standard deviation of its visibility
 * (terms/visibility_error.h). The cure is rays, not subdivision. [D: derived here, on sigma_V of
 * Turbet and Sillion]
 * Fails: it is statistical; of a blocker that no ray meets it fears 1/N.
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_POWER_NOISE_H
#define TOOL_POWER_NOISE_H

#include "discussion.h"
#include "terms/form_factor.h"
#include "terms/visibility_error.h"

TOOL enum power_noise_answer tool_power_noise(struct discussion *d, double watts)
{
    double scale = d->receiver->reflectance * d->receiver->area * d->emitter->radiosity;
    return scale * term_form_factor(d, FORM_FACTOR_POLYGON) * term_visibility_error(d) > watts
               ? POWER_NOISE_LARGE
               : POWER_NOISE_SMALL;
}

#endif
