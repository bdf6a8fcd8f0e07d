/* size.h - a term of dagc's tests: each level has another value.
 * SPDX-License-Identifier: MIT */
#ifndef TERM_SIZE_H
#define TERM_SIZE_H

#include "discussion.h"

TOOL double term_size(struct discussion *d, enum size_level level)
{
    if (d->terms.size_level < level) {
        d->terms.size = 0.1 + 0.7 * (double)level + d->record->facts[0];
        d->terms.size_level = (unsigned char)level;
    }
    return d->terms.size;
}

#endif
