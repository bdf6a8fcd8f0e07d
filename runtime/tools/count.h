/* count.h - command: be counted. It does nothing; the interpreter, when it counts (`radiosity solve
 * --statistics`), says how often it came by, summed over all nodes with the same `as`: so a graph
 * can ask how often paths that meet in no one node were taken, or, with as = receiver.depth, at
 * which depths. Nothing in the flat release.
 * [Turbet & Sillion, section 4.3]
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_COUNT_H
#define TOOL_COUNT_H

#include "discussion.h"

TOOL enum count_answer tool_count(struct discussion *d, int as)
{
    (void)d;
    (void)as;
    return COUNT_DONE;
}

#endif
