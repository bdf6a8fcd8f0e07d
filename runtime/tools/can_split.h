/* can_split.h - question: which of the two may still be split? The guard that makes refinement end:
 * B F on the receiver's side does not shrink when the receiver is split, so a threshold on it
 * alone need not (Turbet & Sillion, section 2; measured: 64 to 1024 elements, same error).
 * Quarters must stay at or above both limits.
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_CAN_SPLIT_H
#define TOOL_CAN_SPLIT_H

#include "discussion.h"

/* 24 halvings leave a face's coordinates 29 bits of a double's 53. */
enum { CAN_SPLIT_DEPTH = 24 };

TOOL enum can_split_answer tool_can_split(struct discussion *d, double min_area, double min_share)
{
    double least = min_share * d->host->area;
    least = 4 * (least > min_area ? least : min_area);
    int r = d->receiver->area >= least && d->receiver->depth < CAN_SPLIT_DEPTH;
    int s = d->emitter->area >= least && d->emitter->depth < CAN_SPLIT_DEPTH;
    return r ? s ? CAN_SPLIT_BOTH : CAN_SPLIT_RECEIVER : s ? CAN_SPLIT_EMITTER : CAN_SPLIT_NEITHER;
}

#endif
