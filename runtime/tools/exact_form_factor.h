/* exact_form_factor.h - command: have the form factor by the contour integral, whatever it costs.
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_EXACT_FORM_FACTOR_H
#define TOOL_EXACT_FORM_FACTOR_H

#include "discussion.h"
#include "terms/form_factor.h"

TOOL enum exact_form_factor_answer tool_exact_form_factor(struct discussion *d)
{
    (void)term_form_factor(d, FORM_FACTOR_CONTOUR);
    return EXACT_FORM_FACTOR_DONE;
}

#endif
