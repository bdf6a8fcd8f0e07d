/* shaft.h - question: is there anything between the two elements? No ray is cast.
 *
 * visible when no face meets their shaft, invisible when one convex face covers it, or when no
 * parts of them face each other: both are true of every segment between them (kernel/shaft.h proves
 * it), and the visibility is then known exactly, 1 or 0, so that no later tool casts a ray.
 * uncertain: some face stands at the shaft's edge or in it, and several together may hide all.
 * too_complex: more than 8 do, or the elements are clusters, or the host has no candidates.
 * Whatever the answer, tools/visibility.h may follow: it finds what is known and casts only what is
 * not. What is known exactly needs no list: that of the pairs below is found when there are any.
 * [Haines & Wallace 1994; Teller & Hanrahan 1993 for "visible" and "invisible"]
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_SHAFT_H
#define TOOL_SHAFT_H

#include "discussion.h"
#include "terms/blockers.h"

TOOL enum shaft_answer tool_shaft(struct discussion *d)
{
    struct blockers own;
    if (d->terms.visibility_level == VISIBILITY_EXACT
        && (d->terms.visibility <= 0 || d->terms.visibility >= 1)) {
        if (d->blockers)
            d->blockers->wanted = 1;
        return d->terms.visibility > 0 ? SHAFT_VISIBLE : SHAFT_INVISIBLE;
    }
    const struct blockers *list = blockers_list(d, &own);
    if (list->count > BLOCKERS_MAX)
        return SHAFT_TOO_COMPLEX;
    if (list->count > 0 && !list->covered)
        return SHAFT_UNCERTAIN;
    d->terms.visibility = list->covered ? 0 : 1;
    d->terms.visibility_level = VISIBILITY_EXACT;
    return list->covered ? SHAFT_INVISIBLE : SHAFT_VISIBLE;
}

#endif
