/* alpha_gap.h - question: cluster_gap's (cluster_gap.h), with what the two may turn to each other:
 * by how much may the irradiance that the emitter brings to the receiver vary, when both are taken
 * for points whose faces keep their own orientation?
 *     (1/pi) (facing area of r / A_r) (facing area of s) B_s (1/(d - a)^2 - 1/(d + a)^2)
 *     (W/m2)
 * d the distance of the centres, a the sum of the radii, facing areas by the normal cones of the
 * children (kernel/cluster_facing.h); held against the larger of `absolute` and `relative` times
 * the scene's mean irradiance. It is never more than what cluster_gap holds against the same, and
 * costs as many cosines as the two have children. Ask it of pairs that cluster_gap found above;
 * nearer than 1.5 a it answers above. Approximate: occlusion is not looked at.
 * [Smits, Arvo, Greenberg 1994, the bound of alpha links; Lischinski et al. 1994 for gaps]
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_ALPHA_GAP_H
#define TOOL_ALPHA_GAP_H

#include "discussion.h"
#include "terms/axis.h"
#include "kernel/cluster_facing.h"
#include "kernel/constants.h"
#include "kernel/lambert.h"
#include "kernel/threshold.h"

OUTLINE double alpha_gap_range(const struct element *r, const struct element *s,
                               const struct element *all, const double axis[3])
{
    double distance = length3(axis), reach = r->radius + s->radius, v[3], back[3];
    if (!(distance > CLUSTER_GAP_APART * reach))
        return INFINITY;
    double slope = reach / distance;
    for (int k = 0; k < 3; k++) {
        v[k] = axis[k] / distance;
        back[k] = -v[k];
    }
    double low = distance - reach;
    double high = distance + reach;
    double facing = cluster_facing_parts(r, all, v, slope);
    if (!(facing > 0)) /* so of an element without area */
        return 0;
    return (1 / LAMBERT_PI) * (facing / r->area) * cluster_facing_parts(s, all, back, slope)
           * s->radiosity * (1 / (low * low) - 1 / (high * high));
}

TOOL enum alpha_gap_answer tool_alpha_gap(struct discussion *d, double absolute, double relative)
{
    /* NULL: there are no clusters */
    const struct element *all = d->host->elements ? *d->host->elements : NULL;
    double limit = threshold(absolute, relative, d->host->irradiance);
    return alpha_gap_range(d->receiver, d->emitter, all, term_axis(d)) > limit ? ALPHA_GAP_ABOVE
                                                                               : ALPHA_GAP_BELOW;
}

#endif
