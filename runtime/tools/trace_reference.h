/* trace_reference.h - command: have the reference for the visibility, by `rays` rays (64, 256, 1024
 * or 4096, the next above) or exactly where the shaft knows it; for studies of other tools, not for
 * oracles.
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_TRACE_REFERENCE_H
#define TOOL_TRACE_REFERENCE_H

#include "discussion.h"
#include "terms/reference.h"

TOOL enum trace_reference_answer tool_trace_reference(struct discussion *d, int rays)
{
    (void)reference_trace(d, rays);
    return TRACE_REFERENCE_DONE;
}

#endif
