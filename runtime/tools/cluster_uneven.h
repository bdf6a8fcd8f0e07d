/* cluster_uneven.h - question: what uneven.h asks, of a pair that holds a group: with A_s / (pi
 * d^2) for the form factor. A group sends by the radiosity of each of its faces, but V is one
 * number for all of them.
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_CLUSTER_UNEVEN_H
#define TOOL_CLUSTER_UNEVEN_H

#include "discussion.h"
#include "kernel/point_intensity.h"
#include "kernel/threshold.h"
#include "terms/unevenness.h"
#include "terms/axis.h"

TOOL enum cluster_uneven_answer tool_cluster_uneven(struct discussion *d, double absolute,
                                                    double relative)
{
    const double *axis = term_axis(d);
    double limit = threshold(absolute, relative, d->host->irradiance);
    return point_intensity(d->emitter, unevenness(d)) > limit * dot3(axis, axis)
               ? CLUSTER_UNEVEN_ABOVE
               : CLUSTER_UNEVEN_BELOW;
}

#endif
