/* mark_emitter.h - command: mark the emitter, an element, for the rounds to come; an element
 * carries one mark. What was given is a term of the discussion: the engine puts it on the element
 * when the round is over, so that no pair of the round can tell which was discussed first. [Turbet
 * & Sillion, section 3.2: commands "mark an element", and may say "No I cannot do it"; one mark,
 * and the least of a round: derived here]
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_MARK_EMITTER_H
#define TOOL_MARK_EMITTER_H

#include "terms/emitter_mark.h"

TOOL enum mark_emitter_answer tool_mark_emitter(struct discussion *d, int as)
{
    int mark = term_emitter_mark(d);
    if (mark && mark != as)
        return MARK_EMITTER_CANNOT;
    d->terms.emitter_mark = as;
    return MARK_EMITTER_DONE;
}

#endif
