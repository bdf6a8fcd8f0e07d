/* uneven.h - question: visibility and radiosity are not independent where both vary over the
 * emitter. May its bright parts be just those that the receiver does not see, or just those that it
 * sees, and the irradiance be wrong for it (terms/unevenness.h) by more than the larger of
 * `absolute` (W/m2) and `relative` times the scene's mean irradiance? Its cure is to split the
 * emitter, whatever the rays say: sixteen that all arrive may have missed the spot. [derived here]
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_UNEVEN_H
#define TOOL_UNEVEN_H

#include "discussion.h"
#include "kernel/threshold.h"
#include "terms/form_factor.h"
#include "terms/unevenness.h"

TOOL enum uneven_answer tool_uneven(struct discussion *d, double absolute, double relative)
{
    double limit = threshold(absolute, relative, d->host->irradiance), most = unevenness(d);
    if (!(most > limit)) /* F <= 1 */
        return UNEVEN_BELOW;
    return most * term_form_factor(d, FORM_FACTOR_DISC) > limit ? UNEVEN_ABOVE : UNEVEN_BELOW;
}

#endif
