/* hemicube_form_factor.h - command: have the form factor at least by a hemicube at the receiver's
 * centre.
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_HEMICUBE_FORM_FACTOR_H
#define TOOL_HEMICUBE_FORM_FACTOR_H

#include "discussion.h"
#include "terms/form_factor.h"

TOOL enum hemicube_form_factor_answer tool_hemicube_form_factor(struct discussion *d)
{
    (void)term_form_factor(d, FORM_FACTOR_HEMICUBE);
    return HEMICUBE_FORM_FACTOR_DONE;
}

#endif
