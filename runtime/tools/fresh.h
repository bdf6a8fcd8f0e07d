/* fresh.h - question: is anything known yet of the visibility between the two? A pair that is
 * discussed the other way round, or whose link is discussed again, starts from what rays found
 * before, and a study that asks 4 rays what 64 have said already would find the 4 better than they
 * are. Precise. [D: derived here]
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_FRESH_H
#define TOOL_FRESH_H

#include "discussion.h"

TOOL enum fresh_answer tool_fresh(struct discussion *d)
{
    return d->terms.visibility_level == VISIBILITY_ABSENT ? FRESH_FRESH : FRESH_KNOWN;
}

#endif
