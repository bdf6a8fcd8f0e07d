/* projected_area.h - question: are both elements' areas, times the cosine of their normal to the
 * line of centres, below the threshold: the larger of `below` (m2) and `share` of the scene's area?
 * How large the one looks from the other, and with it how well few rays measure what is between.
 * Approximate: of surfaces at their centres; a cluster's area is the sum of its faces, its normal
 * the axis of its cone. [Turbet & Sillion, section 5 and figure 4]
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_PROJECTED_AREA_H
#define TOOL_PROJECTED_AREA_H

#include "discussion.h"
#include "terms/receiver_cosine.h"
#include "terms/emitter_cosine.h"

TOOL enum projected_area_answer tool_projected_area(struct discussion *d, double below,
                                                    double share)
{
    double limit = share * d->host->area;
    double r = d->receiver->area * fabs(term_receiver_cosine(d, RECEIVER_COSINE_CENTRE)[0]);
    double s = d->emitter->area * fabs(term_emitter_cosine(d, EMITTER_COSINE_CENTRE)[0]);
    limit = below > limit ? below : limit;
    return r < limit && s < limit ? PROJECTED_AREA_SMALL : PROJECTED_AREA_LARGE;
}

#endif
