/* cluster_noise.h - question: may the rays' noise falsify the irradiance that a link of groups
 * brings, A_s B_s sigma_V / (pi d^2), by more than the larger of `absolute` (W/m2) and `relative`
 * times the scene's mean irradiance? As transfer_noise.h asks it of surfaces.
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_CLUSTER_NOISE_H
#define TOOL_CLUSTER_NOISE_H

#include "discussion.h"
#include "kernel/point_intensity.h"
#include "kernel/threshold.h"
#include "terms/axis.h"
#include "terms/visibility_error.h"

TOOL enum cluster_noise_answer tool_cluster_noise(struct discussion *d, double absolute,
                                                  double relative)
{
    const double *axis = term_axis(d);
    double limit = threshold(absolute, relative, d->host->irradiance);
    return point_intensity(d->emitter, d->emitter->radiosity) * term_visibility_error(d)
                   > limit * dot3(axis, axis)
               ? CLUSTER_NOISE_LARGE
               : CLUSTER_NOISE_SMALL;
}

#endif
