/* outline_visibility.h - question: how much do the two surfaces see of each other past the faces in
 * their shaft, seen from some points of the smaller one (kernel/outline_visibility.h)?
 *
 * Known at rays_64 afterwards, unless it was known better. too_complex: more faces than a list
 * holds, clusters, or a host without candidates; then 64 rays are cast. none and all are
 * approximate: between the points something may be seen.
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_OUTLINE_VISIBILITY_H
#define TOOL_OUTLINE_VISIBILITY_H

#include "discussion.h"
#include "kernel/outline_visibility.h"
#include "terms/blockers.h"
#include "terms/visibility.h"

TOOL enum outline_visibility_answer tool_outline_visibility(struct discussion *d)
{
    if (d->terms.visibility_level < VISIBILITY_RAYS_64) {
        struct blockers own;
        const struct blockers *list = blockers_list(d, &own);
        if (list->count > BLOCKERS_MAX) {
            (void)term_visibility(d, VISIBILITY_RAYS_64);
            return OUTLINE_VISIBILITY_TOO_COMPLEX;
        }
        d->terms.visibility = list->covered ? 0
                              : list->count == 0
                                  ? 1
                                  : outline_visibility(d->receiver, d->emitter, d->host, list);
        d->terms.visibility_level = VISIBILITY_RAYS_64;
    }
    return d->terms.visibility <= 0  ? OUTLINE_VISIBILITY_NONE
           : d->terms.visibility < 1 ? OUTLINE_VISIBILITY_PARTIAL
                                     : OUTLINE_VISIBILITY_ALL;
}

#endif
