/* times.h - a term of dagc's tests.
 * SPDX-License-Identifier: MIT */
#ifndef TERM_TIMES_H
#define TERM_TIMES_H

#include "discussion.h"

TOOL int term_times(struct discussion *d)
{
    if (d->terms.times_level < TIMES_PRESENT) {
        d->terms.times = 3;
        d->terms.times_level = TIMES_PRESENT;
    }
    return d->terms.times;
}

#endif
