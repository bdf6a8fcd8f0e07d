/* receiver_cosine.h - term: the cosine between the receiver's normal and the direction from its
 * point to the other's, least and largest. Dimensionless, in [-1, 1]; negative where the other lies
 * behind. For a cluster, of any of its normals.
 *
 * centre  both are the cosine between the centres, 0 where these coincide; a cluster's normal is
 * its cone's axis. bound   no two points have a cosine outside (cosine_bound.h); of surfaces, the
 * least is exact where all of the other lies in front.
 * SPDX-License-Identifier: MIT */
#ifndef TERM_RECEIVER_COSINE_H
#define TERM_RECEIVER_COSINE_H

#include "discussion.h"
#include "terms/axis.h"
#include "kernel/cosine_bound.h"

TOOL const double *term_receiver_cosine(struct discussion *d, enum receiver_cosine_level level)
{
    if (d->terms.receiver_cosine_level < level) {
        double range[2];
        if (level == RECEIVER_COSINE_CENTRE)
            range[0] = range[1] = cosine_centre(d->receiver->normal, term_axis(d));
        else
            cosine_bound(d->receiver, d->emitter, range);
        d->terms.receiver_cosine[0] = range[0];
        d->terms.receiver_cosine[1] = range[1];
        d->terms.receiver_cosine_level = (unsigned char)level;
    }
    return d->terms.receiver_cosine;
}

#endif
