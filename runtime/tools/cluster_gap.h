/* cluster_gap.h - question: by how much may the irradiance that the emitter brings to the receiver
 * vary, when both are taken for points? With a the sum of the radii and d the distance of the
 * centres, J / d^2 lies between J / (d + a)^2 and J / (d - a)^2, and the intensity J is at most A_s
 * B_s / pi; their difference is held against the larger of `absolute` (W/m2) and `relative` times
 * the scene's mean irradiance. near: d below 1.5 a, where nothing of the kind holds. Approximate:
 * what faces turn to each other is bounded, not known, and occlusion not looked at.
 * [Smits, Arvo, Greenberg 1994, the bound of beta links; Lischinski et al. 1994 for gaps]
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_CLUSTER_GAP_H
#define TOOL_CLUSTER_GAP_H

#include "discussion.h"
#include "kernel/constants.h"
#include "kernel/point_intensity.h"
#include "kernel/threshold.h"
#include "terms/axis.h"

TOOL enum cluster_gap_answer tool_cluster_gap(struct discussion *d, double absolute,
                                              double relative)
{
    const struct element *r = d->receiver, *s = d->emitter;
    const double *axis = term_axis(d);
    double limit = threshold(absolute, relative, d->host->irradiance), square = dot3(axis, axis),
           reach = r->radius + s->radius;
    if (s->black)
        return CLUSTER_GAP_DARK;
    if (!(square > CLUSTER_GAP_APART * CLUSTER_GAP_APART * reach * reach))
        return CLUSTER_GAP_NEAR;
    double distance = sqrt(square);
    double low = distance - reach;
    double high = distance + reach;
    return point_intensity(s, s->radiosity) * (1 / (low * low) - 1 / (high * high)) > limit
               ? CLUSTER_GAP_ABOVE
               : CLUSTER_GAP_BELOW;
}

#endif
