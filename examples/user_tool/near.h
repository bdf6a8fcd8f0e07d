/* near.h - question: is the gap between the two smaller than `times` the larger radius? Precise, as
 * the gap is.
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_NEAR_H
#define TOOL_NEAR_H

#include "discussion.h"
#include "gap.h"

TOOL enum near_answer tool_near(struct discussion *d, double times)
{
    double radius = d->receiver->radius > d->emitter->radius ? d->receiver->radius : d->emitter->radius;
    return term_gap(d) < times * radius ? NEAR_NEAR : NEAR_FAR;
}

#endif
