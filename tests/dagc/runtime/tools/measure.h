/* measure.h - a tool of dagc's tests.
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_MEASURE_H
#define TOOL_MEASURE_H

#include "discussion.h"

TOOL enum measure_answer tool_measure(struct discussion *d)
{
    d->terms.size = d->record->calls;
    d->terms.size_level = SIZE_FINE;
    d->terms.where[0] = d->terms.where[1] = d->terms.where[2] = d->record->calls;
    d->terms.where_level = WHERE_PRESENT;
    return (enum measure_answer)answer(d, 3, 0, 0, MEASURE_ANSWERS);
}

#endif
