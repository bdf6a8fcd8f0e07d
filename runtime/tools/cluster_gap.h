/* cluster_gap.h - question: by how much may the irradiance that the emitter brings vary over the receiver, when
 * both are taken for points? J/d^2 lies between J/(d+a)^2 and J/(d-a)^2, a the sum of the radii, J at most A_s B_s / pi.
 * near: the spheres meet.
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_CLUSTER_GAP_H
#define TOOL_CLUSTER_GAP_H

#include "discussion.h"
#include "terms/axis.h"

TOOL enum cluster_gap_answer tool_cluster_gap(struct discussion *d, double absolute, double relative)
{
    const double *axis = term_axis(d);
    const struct element *r = d->receiver, *s = d->emitter;
    double limit = relative * d->host->irradiance, square = dot3(axis, axis), reach = r->radius + s->radius, distance, low, high;
    if (s->black)
        return CLUSTER_GAP_DARK;
    if (absolute > limit)
        limit = absolute;
    if (r == s || square <= 1.5 * 1.5 * reach * reach)
        return CLUSTER_GAP_NEAR;
    distance = sqrt(square);
    low = distance - reach;
    high = distance + reach;
    return 0.31830988618379067154 * s->area * s->radiosity * (1 / (low * low) - 1 / (high * high)) > limit ? CLUSTER_GAP_ABOVE : CLUSTER_GAP_BELOW;
}

#endif
