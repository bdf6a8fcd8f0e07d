/* marked.h - question: which of the two elements carry a mark that a discussion gave them
 * (mark_receiver, mark_emitter)? [D: derived here]
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_MARKED_H
#define TOOL_MARKED_H

#include "terms/emitter_mark.h"
#include "terms/receiver_mark.h"

TOOL enum marked_answer tool_marked(struct discussion *d, int as)
{
    int receiver = term_receiver_mark(d) == as, emitter = term_emitter_mark(d) == as;
    return receiver && emitter ? MARKED_BOTH
           : receiver          ? MARKED_RECEIVER
           : emitter           ? MARKED_EMITTER
                               : MARKED_NONE;
}

#endif
