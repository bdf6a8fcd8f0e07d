/* exact_visibility.h - question: how much do the two elements see of each other, exactly?
 *
 * When the shaft is empty, or one or two faces stand in it, the visibility is integrated
 * (kernel/visible_part.h, to 1e-6) and is then at level exact. too_complex: more faces, clusters,
 * or a host without candidates; then 64 rays are cast. Either way the visibility is known at
 * rays_64 or better.
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_EXACT_VISIBILITY_H
#define TOOL_EXACT_VISIBILITY_H

#include "discussion.h"
#include "terms/blockers.h"
#include "terms/visibility.h"
#include "kernel/visible_part.h"

TOOL enum exact_visibility_answer tool_exact_visibility(struct discussion *d)
{
    if (d->terms.visibility_level < VISIBILITY_EXACT) {
        struct blockers own;
        const struct blockers *list = blockers_list(d, &own);
        double v = list->count > BLOCKERS_MAX ? -1
                   : list->covered            ? 0
                   : list->count == 0
                       ? 1
                       : visible_part_fraction(d->receiver, d->emitter, d->host, list);
        if (v < 0) {
            (void)term_visibility(d, VISIBILITY_RAYS_64);
            return EXACT_VISIBILITY_TOO_COMPLEX;
        }
        d->terms.visibility = v;
        d->terms.visibility_level = VISIBILITY_EXACT;
    }
    return d->terms.visibility <= 0  ? EXACT_VISIBILITY_NONE
           : d->terms.visibility < 1 ? EXACT_VISIBILITY_PARTIAL
                                     : EXACT_VISIBILITY_ALL;
}

#endif
