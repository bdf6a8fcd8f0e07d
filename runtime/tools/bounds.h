/* bounds.h - question: how far apart are the bounds of what this link adds to the receiver's
 * radiosity? W/m2.
 *
 * rho F_hi V_hi B_hi - rho F_lo V_lo B_lo against the larger of `absolute` and `relative` times the
 * scene's mean radiosity. F: its range over the receiver, bounded, not sampled. B: what the
 * emitter's parts have, within its spread of its mean. V: [0, 1] unless rays or a shaft say all (1)
 * or none (0). rho is the same all over an element. The side whose bounds are wider apart is to be
 * split: the receiver by F and V, the emitter by B.
 * [after Gibson and Hubbold 1996, of which only the abstract was at hand: the rule is as commonly
 * told]
 * Fails: as long as B is only known at a coarse level its bounds are those of that level, no more;
 * partial visibility counts in full; where elements touch F_hi - F_lo does not shrink.
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_BOUNDS_H
#define TOOL_BOUNDS_H

#include "discussion.h"
#include "kernel/threshold.h"
#include "terms/form_factor_range.h"

TOOL enum bounds_answer tool_bounds(struct discussion *d, double absolute, double relative)
{
    const struct element *s = d->emitter;
    double limit = threshold(absolute, relative, d->host->radiosity),
           rho = d->receiver->reflectance;
    double v_low = 0, v_high = 1, b_low = s->radiosity - s->spread,
           b_high = s->radiosity + s->spread;
    if (!(rho * b_high > limit)) /* F <= 1 */
        return BOUNDS_BELOW;
    const double *f = term_form_factor_range(d, FORM_FACTOR_RANGE_BOUNDED);
    if (d->terms.visibility_level > VISIBILITY_ABSENT) {
        v_low = d->terms.visibility < 1 ? 0 : 1;
        v_high = d->terms.visibility > 0 ? 1 : 0;
    }
    b_low = b_low > 0 ? b_low : 0;
    double high = f[1] * v_high;
    double low = f[0] * v_low;
    if (!(rho * (high * b_high - low * b_low) > limit))
        return BOUNDS_BELOW;
    return (high - low) * s->radiosity >= high * (b_high - b_low) ? BOUNDS_RECEIVER
                                                                  : BOUNDS_EMITTER;
}

#endif
