/* gradient.h - command: have the gradient of F at the receiver's centre.
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_GRADIENT_H
#define TOOL_GRADIENT_H

#include "discussion.h"
#include "terms/gradient.h"

TOOL enum gradient_answer tool_gradient(struct discussion *d)
{
    (void)term_gradient(d);
    return GRADIENT_DONE;
}

#endif
