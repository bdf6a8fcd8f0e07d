/* beside.h - question: is the gap between the two smaller than `times` the larger radius? Precise,
 * as the gap is.
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_BESIDE_H
#define TOOL_BESIDE_H

#include "discussion.h"
#include "gap.h"

TOOL enum beside_answer tool_beside(struct discussion *d, double times)
{
    double radius =
        d->receiver->radius > d->emitter->radius ? d->receiver->radius : d->emitter->radius;
    return term_gap(d) < times * radius ? BESIDE_NEAR : BESIDE_FAR;
}

#endif
