/* mark_receiver.h - command: mark the receiver, an element, for the rounds to come; an element
 * carries one mark. What was given is a term of the discussion: the engine puts it on the element
 * when the round is over, so that no pair of the round can tell which was discussed first. [Turbet
 * & Sillion, section 3.2: commands "mark an element", and may say "No I cannot do it"; one mark,
 * and the least of a round: derived here]
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_MARK_RECEIVER_H
#define TOOL_MARK_RECEIVER_H

#include "terms/receiver_mark.h"

TOOL enum mark_receiver_answer tool_mark_receiver(struct discussion *d, int as)
{
    int mark = term_receiver_mark(d);
    if (mark && mark != as)
        return MARK_RECEIVER_CANNOT;
    d->terms.receiver_mark = as;
    return MARK_RECEIVER_DONE;
}

#endif
