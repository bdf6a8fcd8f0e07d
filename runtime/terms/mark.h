/* mark.h - term: what a graph has marked the pair with, 1 to 7; 0: nothing. A link keeps its mark,
 * and the solver says how many links carry each: a refinement that ends because it must, not
 * because it may, shows.
 * SPDX-License-Identifier: MIT */
#ifndef TERM_MARK_H
#define TERM_MARK_H

#include "discussion.h"

TOOL int term_mark(struct discussion *d)
{
    d->terms.mark_level = MARK_PRESENT;
    return d->terms.mark;
}

#endif
