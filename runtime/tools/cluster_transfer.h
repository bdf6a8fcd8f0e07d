/* cluster_transfer.h - question: may the emitter, taken for a point, bring more irradiance, A_s B_s
 * / (pi d^2), than the larger of `absolute` (W/m2) and `relative` times the scene's mean
 * irradiance? Approximate: as cluster_gap.h.
 * [Hanrahan et al. 1991, section 5, for clusters]
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_CLUSTER_TRANSFER_H
#define TOOL_CLUSTER_TRANSFER_H

#include "discussion.h"
#include "kernel/point_intensity.h"
#include "kernel/threshold.h"
#include "terms/axis.h"

TOOL enum cluster_transfer_answer tool_cluster_transfer(struct discussion *d, double absolute,
                                                        double relative)
{
    const double *axis = term_axis(d);
    double limit = threshold(absolute, relative, d->host->irradiance);
    return point_intensity(d->emitter, d->emitter->radiosity) > limit * dot3(axis, axis)
               ? CLUSTER_TRANSFER_ABOVE
               : CLUSTER_TRANSFER_BELOW;
}

#endif
