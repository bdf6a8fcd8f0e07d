/* receiver_mark.h - term: what the receiver is marked with, 1 to 7; 0: nothing. It is what the
 * rounds before left on the element, until this discussion marks it.
 * SPDX-License-Identifier: MIT */
#ifndef TERM_RECEIVER_MARK_H
#define TERM_RECEIVER_MARK_H

#include "discussion.h"

TOOL int term_receiver_mark(struct discussion *d)
{
    if (d->terms.receiver_mark_level == RECEIVER_MARK_ABSENT) {
        d->terms.receiver_mark = (int)d->receiver->mark;
        d->terms.receiver_mark_level = RECEIVER_MARK_PRESENT;
    }
    return d->terms.receiver_mark;
}

#endif
