/* weigh.h - a tool of dagc's tests.
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_WEIGH_H
#define TOOL_WEIGH_H

#include "discussion.h"

TOOL enum weigh_answer tool_weigh(struct discussion *d, double most, double share)
{
    return (enum weigh_answer)answer(d, 1, most, share, WEIGH_ANSWERS);
}

#endif
