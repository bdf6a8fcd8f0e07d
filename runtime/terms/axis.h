/* axis.h - term: the vector from the receiver's centre to the emitter's (m).
 * SPDX-License-Identifier: MIT */
#ifndef TERM_AXIS_H
#define TERM_AXIS_H

#include "discussion.h"

TOOL const double *term_axis(struct discussion *d)
{
    if (d->terms.axis_level < AXIS_PRESENT) {
        sub3(d->terms.axis, d->emitter->centre, d->receiver->centre);
        d->terms.axis_level = AXIS_PRESENT;
    }
    return d->terms.axis;
}

#endif
