/* above.h - question: is one number above another? For what a graph computes of facts, terms and
 * parameters, in whatever unit: the catalog sees to it that both have the same.
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_ABOVE_H
#define TOOL_ABOVE_H

#include "discussion.h"

TOOL enum above_answer tool_above(struct discussion *d, double value, double limit)
{
    (void)d;
    return value > limit ? ABOVE_YES : ABOVE_NO;
}

#endif
