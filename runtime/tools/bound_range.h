/* bound_range.h - command: have two numbers that enclose F at every point of the receiver.
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_BOUND_RANGE_H
#define TOOL_BOUND_RANGE_H

#include "discussion.h"
#include "terms/form_factor_range.h"

TOOL enum bound_range_answer tool_bound_range(struct discussion *d)
{
    (void)term_form_factor_range(d, FORM_FACTOR_RANGE_BOUNDED);
    return BOUND_RANGE_DONE;
}

#endif
