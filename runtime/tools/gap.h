/* gap.h - question: how far apart may the radiosities be that this link gives the receiver's
 * points? W/m2.
 *
 * rho_r B_s (V F_max - V' F_min) + rho_r e_s V F_max, times `weight`, against the larger of
 * `absolute` and `relative` times the scene's mean radiosity. F_min and F_max: the range of F over
 * the receiver; e_s: the spread of B over the emitter; V and V': the most and the least that may be
 * visible, 1 and 0 where some rays arrive and others do not, both 1 as long as no ray was cast,
 * both the visibility where rays or a shaft agree. The larger of the two terms says who is to be
 * split. [Lischinski et al. 1994, in the form of Bekaert and Willems 1996; `weight`: Smits et al.
 * 1992] Of what approximate terms say it is as sure as they are.
 * Fails: in half shadow all of F counts, however narrow the range of the visibility really is;
 * where two elements touch, F ranges over the same values at every size, and only a guard ends it;
 * sampled, it may miss the extremum.
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_GAP_H
#define TOOL_GAP_H

#include "discussion.h"
#include "kernel/threshold.h"
#include "terms/form_factor_range.h"

TOOL enum gap_answer tool_gap(struct discussion *d, double absolute, double relative, double weight)
{
    double limit = threshold(absolute, relative, d->host->radiosity), most = 1, least = 1;
    double scale = weight * d->receiver->reflectance;
    if (!(scale * (d->emitter->radiosity + d->emitter->spread) > limit)) /* F <= 1 */
        return GAP_SMALL;
    const double *f = term_form_factor_range(d, FORM_FACTOR_RANGE_SAMPLED);
    if (d->terms.visibility_level > VISIBILITY_ABSENT && d->terms.visibility < 1) {
        most = d->terms.visibility > 0 ? 1 : 0;
        least = 0;
    }
    double shape = scale * d->emitter->radiosity * (most * f[1] - least * f[0]);
    double light = scale * d->emitter->spread * most * f[1];
    if (!(shape + light > limit))
        return GAP_SMALL;
    return shape >= light ? GAP_RECEIVER : GAP_EMITTER;
}

#endif
