/* gap.h - term: the distance between the spheres around the two elements (m), 0 when they meet.
 * SPDX-License-Identifier: MIT */
#ifndef TERM_GAP_H
#define TERM_GAP_H

#include "discussion.h"
#include "terms/axis.h"

TOOL double term_gap(struct discussion *d)
{
    if (d->terms.gap_level < GAP_PRESENT) {
        const double *axis = term_axis(d);
        double gap = sqrt(dot3(axis, axis)) - d->receiver->radius - d->emitter->radius;
        d->terms.gap = gap > 0 ? gap : 0;
        d->terms.gap_level = GAP_PRESENT;
    }
    return d->terms.gap;
}

#endif
