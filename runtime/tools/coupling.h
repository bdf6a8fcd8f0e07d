/* coupling.h - question: is one of the two form factors, F_rs = A_s/A_r F_sr and F_sr, above the
 * limit? Dimensionless. The "FF criterion": it knows of the elements' shape and not of their light,
 * so one mesh serves every lamp, and bright and dark pairs cost the same. dark: this emitter never
 * sends light. Approximate: F is the estimate at hand, the disc when nothing better is known.
 * Fails: a small F between a lamp and a wall may still carry most of the light.
 * [Hanrahan et al. 1991, section 4]
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_COUPLING_H
#define TOOL_COUPLING_H

#include "discussion.h"
#include "terms/form_factor.h"

TOOL enum coupling_answer tool_coupling(struct discussion *d, double limit)
{
    double area_r = d->receiver->area, area_s = d->emitter->area;
    if (d->emitter->black)
        return COUPLING_DARK;
    double there = term_form_factor(d, FORM_FACTOR_DISC);
    return there > limit || there * area_r > limit * area_s ? COUPLING_ABOVE : COUPLING_BELOW;
}

#endif
