/* reference.h - question: what does the reference say of the visibility: none, partial or all?
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_REFERENCE_H
#define TOOL_REFERENCE_H

#include "discussion.h"
#include "terms/reference.h"

TOOL enum reference_answer tool_reference(struct discussion *d)
{
    double v = term_reference(d);
    return v <= 0 ? REFERENCE_NONE : v < 1 ? REFERENCE_PARTIAL : REFERENCE_ALL;
}

#endif
