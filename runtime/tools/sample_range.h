/* sample_range.h - command: have the range of F over the receiver's corners and centre.
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_SAMPLE_RANGE_H
#define TOOL_SAMPLE_RANGE_H

#include "discussion.h"
#include "terms/form_factor_range.h"

TOOL enum sample_range_answer tool_sample_range(struct discussion *d)
{
    (void)term_form_factor_range(d, FORM_FACTOR_RANGE_SAMPLED);
    return SAMPLE_RANGE_DONE;
}

#endif
