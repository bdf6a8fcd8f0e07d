/* presume_visible.h - command: take the visibility for 1, unless something is known of it.
 *
 * For a link between groups whose faces find out themselves what they see of each other, as the
 * rows of view factors do (engine/exchange_areas.c). No ray is cast.
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_PRESUME_VISIBLE_H
#define TOOL_PRESUME_VISIBLE_H

#include "discussion.h"

TOOL enum presume_visible_answer tool_presume_visible(struct discussion *d)
{
    if (d->terms.visibility_level < VISIBILITY_PRESUMED) {
        d->terms.visibility = 1;
        d->terms.visibility_level = VISIBILITY_PRESUMED;
    }
    return PRESUME_VISIBLE_DONE;
}

#endif
