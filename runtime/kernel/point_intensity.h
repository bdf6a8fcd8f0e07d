/* point_intensity.h - A_s B / pi (W/sr), the most that an emitter of radiosity B sends in any
 * direction when it is taken for a point; over d^2, irradiance.
 * SPDX-License-Identifier: MIT */
#ifndef KERNEL_POINT_INTENSITY_H
#define KERNEL_POINT_INTENSITY_H

#include "discussion.h"
#include "kernel/lambert.h"

static inline double point_intensity(const struct element *s, double radiosity)
{
    return (1 / LAMBERT_PI) * s->area * radiosity;
}

#endif
