/* inverse_square_form_factor.h - command: have the form factor at least by the kernel of the two
 * centres.
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_INVERSE_SQUARE_FORM_FACTOR_H
#define TOOL_INVERSE_SQUARE_FORM_FACTOR_H

#include "discussion.h"
#include "terms/form_factor.h"

TOOL enum inverse_square_form_factor_answer tool_inverse_square_form_factor(struct discussion *d)
{
    (void)term_form_factor(d, FORM_FACTOR_INVERSE_SQUARE);
    return INVERSE_SQUARE_FORM_FACTOR_DONE;
}

#endif
