/* mark.h - command: mark the pair, so that its link can be counted among those that the graph
 * treats apart. By convention 1 says that the link was too large for the oracle and could not be
 * split. [D: derived here]
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_MARK_H
#define TOOL_MARK_H

#include "discussion.h"

TOOL enum mark_answer tool_mark(struct discussion *d, int as)
{
    d->terms.mark = as;
    d->terms.mark_level = MARK_PRESENT;
    return MARK_DONE;
}

#endif
