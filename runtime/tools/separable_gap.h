/* separable_gap.h - question: by how much may the irradiance over a link of groups be wrong because
 * the kernel between them is taken for a product of one factor per side? near: their spheres meet,
 * where nothing of the kind holds. dark: the emitter sends no light.
 *
 * What is left of the kernel is of second order, in the product of both sizes over the square of
 * the distance (engine/separable_links.h). SEPARABLE_ERROR times that product, of A_s B_s / (pi
 * d^2), is held against the larger of `absolute` (W/m2) and `relative` times the scene's mean
 * irradiance. Approximate: an error that was measured, not a bound, and occlusion not looked at.
 * [derived here]
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_SEPARABLE_GAP_H
#define TOOL_SEPARABLE_GAP_H

#include "discussion.h"
#include "kernel/constants.h"
#include "kernel/point_intensity.h"
#include "kernel/threshold.h"
#include "terms/axis.h"

TOOL enum separable_gap_answer tool_separable_gap(struct discussion *d, double absolute,
                                                  double relative)
{
    const struct element *r = d->receiver, *s = d->emitter;
    const double *axis = term_axis(d);
    double limit = threshold(absolute, relative, d->host->irradiance), square = dot3(axis, axis),
           reach = r->radius + s->radius;
    if (s->black)
        return SEPARABLE_GAP_DARK;
    if (!(square > reach * reach))
        return SEPARABLE_GAP_NEAR;
    return point_intensity(s, s->radiosity) * SEPARABLE_ERROR * r->radius * s->radius
                   > limit * square * square
               ? SEPARABLE_GAP_ABOVE
               : SEPARABLE_GAP_BELOW;
}

#endif
