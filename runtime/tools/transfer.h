/* transfer.h - question: is the irradiance that the emitter brings to the receiver, B_s F_rs with
 * nothing between them, above the threshold (W/m2)? The "BF criterion". Approximate: F is the
 * estimate at hand, the disc when nothing better is known. [Hanrahan et al. 1991, section 5]
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_TRANSFER_H
#define TOOL_TRANSFER_H

#include "discussion.h"
#include "kernel/threshold.h"
#include "terms/form_factor.h"

TOOL enum transfer_answer tool_transfer(struct discussion *d, double absolute, double relative)
{
    double limit = threshold(absolute, relative, d->host->irradiance);
    if (d->emitter->black)
        return TRANSFER_DARK;
    if (!(d->emitter->radiosity > limit)) /* F <= 1 */
        return TRANSFER_BELOW;
    return d->emitter->radiosity * term_form_factor(d, FORM_FACTOR_DISC) > limit ? TRANSFER_ABOVE
                                                                                 : TRANSFER_BELOW;
}

#endif
