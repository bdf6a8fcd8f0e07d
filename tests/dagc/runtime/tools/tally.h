/* tally.h - a tool of dagc's tests.
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_TALLY_H
#define TOOL_TALLY_H

#include "discussion.h"

TOOL enum tally_answer tool_tally(struct discussion *d, int upto, double scale)
{
    d->terms.times += upto;
    d->terms.times_level = TIMES_PRESENT;
    return (enum tally_answer)answer(d, 2, upto, scale, TALLY_ANSWERS);
}

#endif
