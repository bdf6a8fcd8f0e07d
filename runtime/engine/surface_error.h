/* surface_error.h - how far radiosities are from the truth, point by point: measured, with an
 * interval.
 * SPDX-License-Identifier: MIT */
#ifndef SURFACE_ERROR_H
#define SURFACE_ERROR_H

#include "engine/element_light.h"
#include "particles/particles.h"

/* Of e = B~ - B over all points of surfaces that reflect and that no solid covers; B - E is the
 * light they reflect. */
struct surface_error {
    /* sqrt(integral e^2 dA / integral (B - E)^2 dA), bands summed under both integrals */
    struct RadMeasure l2;
    uint64_t rays;
};

/* The error of a light, point by point, slopes and all, by about so many `rays`; 20,000 give a
 * rough idea. Another stream gives another, independent answer; the number of threads does not
 * show. Scenes where nothing shines or nothing reflects: all zero. watch: NULL, or asked. Returns
 * 0, or -1 when out of memory or stopped by `watch`. */
int surface_error_measure(const struct solve *s, const struct tracer *t,
                          const struct element_light *light, uint64_t rays, uint64_t stream,
                          const struct watch *watch, struct surface_error *out);

#endif
