/* where.h - a term of dagc's tests.
 * SPDX-License-Identifier: MIT */
#ifndef TERM_WHERE_H
#define TERM_WHERE_H

#include "discussion.h"

TOOL const double *term_where(struct discussion *d)
{
    if (d->terms.where_level < WHERE_PRESENT) {
        d->terms.where[0] = d->terms.where[1] = d->terms.where[2] = d->record->calls;
        d->terms.where_level = WHERE_PRESENT;
    }
    return d->terms.where;
}

#endif
