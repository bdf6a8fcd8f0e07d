/* reference.h - term: the visibility by so many rays that others are judged by it. Dimensionless,
 * in [0, 1].
 *
 * Where the shaft knows, it is 0 or 1 exactly; else by 64, 256, 1024 or 4096 rays, 1024 unless
 * tools/trace_reference.h asked for another number. It is kept apart from term visibility, so that
 * what coarser tools find is what they found. Its error is that of its rays, sqrt(v (1 - v) / N).
 * SPDX-License-Identifier: MIT */
#ifndef TERM_REFERENCE_H
#define TERM_REFERENCE_H

#include "discussion.h"
#include "terms/blockers.h"
#include "terms/visibility.h"

enum { REFERENCE_RAYS = 1024 };

TOOL double reference_trace(struct discussion *d, int rays)
{
    struct blockers own;
    const struct blockers *list = blockers_list(d, &own);
    if (list->count <= BLOCKERS_MAX && (list->covered || list->count == 0))
        d->terms.reference = list->covered ? 0 : 1;
    else
        d->terms.reference = visibility_rays(d->receiver, d->emitter, d->host,
                                             rays <= 64     ? 64
                                             : rays <= 256  ? 256
                                             : rays <= 1024 ? 1024
                                                            : SOBOL_MOST,
                                             0);
    d->terms.reference_level = REFERENCE_PRESENT;
    return d->terms.reference;
}

TOOL double term_reference(struct discussion *d)
{
    return d->terms.reference_level < REFERENCE_PRESENT ? reference_trace(d, REFERENCE_RAYS)
                                                        : d->terms.reference;
}

#endif
