/* record.h - command: put a number into a histogram whose bins are powers of two. It does nothing;
 * the interpreter, when it counts (`radiosity solve --statistics`), keeps 8 such histograms, by
 * `slot`. `value` is dimensionless: divide by what it is to be compared with, as in record(value =
 * emitter.radiosity * form_factor / scene.irradiance). What the expression reads is computed in
 * every release, so that all decide alike; nothing else is left in the flat one. Sillion and
 * Drettakis choose the next threshold from such a histogram of link errors [1995, section 6.2].
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_RECORD_H
#define TOOL_RECORD_H

#include "discussion.h"

TOOL enum record_answer tool_record(struct discussion *d, double value, int slot)
{
    (void)d;
    (void)value;
    (void)slot;
    return RECORD_DONE;
}

#endif
