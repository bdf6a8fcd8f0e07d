/* extinction.h - command: the visibility as if the clusters between the two elements were fog,
 * unless it is known better.
 *
 * V = exp(-sum kappa_i l_i) over the clusters which the segment between the centres passes, l_i the
 * length inside (m), and kappa = sum A / (4 Vol) the extinction of randomly turned surfaces of area
 * A (1/m). Clusters that hold the receiver's or the emitter's own face do not count. No ray is
 * cast. [Sillion & Drettakis 1995, section 3]
 * Fails: its error is not characterised; clusters of few or parallel faces are no fog; hosts
 * without optical_depth have V = 1.
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_EXTINCTION_H
#define TOOL_EXTINCTION_H

#include "discussion.h"

OUTLINE double extinction_visibility(const struct element *receiver, const struct element *emitter,
                                     const struct host *host)
{
    const struct element *r = receiver->id < emitter->id ? receiver : emitter,
                         *s = r == receiver ? emitter : receiver;
    if (!host->optical_depth)
        return 1;
    struct segment centres;
    for (int k = 0; k < 3; k++) {
        centres.from[k] = r->centre[k];
        centres.to[k] = s->centre[k];
    }
    return exp(-host->optical_depth(host, &centres, r->vertices ? r->face : UINT32_MAX,
                                    s->vertices ? s->face : UINT32_MAX));
}

TOOL enum extinction_answer tool_extinction(struct discussion *d)
{
    if (d->terms.visibility_level < VISIBILITY_EXTINCTION) {
        d->terms.visibility = extinction_visibility(d->receiver, d->emitter, d->host);
        d->terms.visibility_level = VISIBILITY_EXTINCTION;
    }
    return EXTINCTION_DONE;
}

#endif
