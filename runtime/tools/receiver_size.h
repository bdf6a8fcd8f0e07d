/* receiver_size.h - question: is the receiver narrower than `below` (m), or than `share` of the
 * scene's extent, whichever is larger? Its width is the diameter of its bounding sphere. No shadow
 * on it is larger than it is: where smaller shadows need not be drawn, a mean over it will do.
 * [Sillion & Drettakis 1995, section 5, the receiver's side of the umbra]
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_RECEIVER_SIZE_H
#define TOOL_RECEIVER_SIZE_H

#include "discussion.h"

TOOL enum receiver_size_answer tool_receiver_size(struct discussion *d, double below, double share)
{
    double least = share * d->host->extent;
    if (below > least)
        least = below;
    return 2 * d->receiver->radius < least ? RECEIVER_SIZE_SMALL : RECEIVER_SIZE_BIG;
}

#endif
