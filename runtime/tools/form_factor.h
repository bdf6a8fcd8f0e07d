/* form_factor.h - command: have the form factor at the level that a link deserves, the clipped
 * polygon.
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_FORM_FACTOR_H
#define TOOL_FORM_FACTOR_H

#include "discussion.h"
#include "terms/form_factor.h"

TOOL enum form_factor_answer tool_form_factor(struct discussion *d)
{
    (void)term_form_factor(d, FORM_FACTOR_POLYGON);
    return FORM_FACTOR_DONE;
}

#endif
