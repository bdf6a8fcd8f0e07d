/* emitter_mark.h - term: what the emitter is marked with, 1 to 7; 0: nothing. It is what the rounds
 * before left on the element, until this discussion marks it.
 * SPDX-License-Identifier: MIT */
#ifndef TERM_EMITTER_MARK_H
#define TERM_EMITTER_MARK_H

#include "discussion.h"

TOOL int term_emitter_mark(struct discussion *d)
{
    if (d->terms.emitter_mark_level == EMITTER_MARK_ABSENT) {
        d->terms.emitter_mark = (int)d->emitter->mark;
        d->terms.emitter_mark_level = EMITTER_MARK_PRESENT;
    }
    return d->terms.emitter_mark;
}

#endif
