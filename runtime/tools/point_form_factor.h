/* point_form_factor.h - command: have the form factor at least as the receiver's centre sees the
 * clipped polygon.
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_POINT_FORM_FACTOR_H
#define TOOL_POINT_FORM_FACTOR_H

#include "discussion.h"
#include "terms/form_factor.h"

TOOL enum point_form_factor_answer tool_point_form_factor(struct discussion *d)
{
    (void)term_form_factor(d, FORM_FACTOR_POINT);
    return POINT_FORM_FACTOR_DONE;
}

#endif
