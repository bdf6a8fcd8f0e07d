/* ray_form_factor.h - command: have the form factor at least by rays between the two.
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_RAY_FORM_FACTOR_H
#define TOOL_RAY_FORM_FACTOR_H

#include "discussion.h"
#include "terms/form_factor.h"

TOOL enum ray_form_factor_answer tool_ray_form_factor(struct discussion *d)
{
    (void)term_form_factor(d, FORM_FACTOR_RAYS);
    return RAY_FORM_FACTOR_DONE;
}

#endif
