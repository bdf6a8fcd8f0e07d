/* distance.h - term: the distance between points of the receiver and points of the emitter, least
 * and largest (m).
 *
 * centre  both are the distance of the centres.
 * bound   no two points are nearer than [0] or farther than [1] (kernel/element_distance.h).
 * SPDX-License-Identifier: MIT */
#ifndef TERM_DISTANCE_H
#define TERM_DISTANCE_H

#include "discussion.h"
#include "kernel/element_distance.h"
#include "terms/axis.h"

TOOL const double *term_distance(struct discussion *d, enum distance_level level)
{
    if (d->terms.distance_level < level) {
        double range[2];
        if (level == DISTANCE_CENTRE)
            range[0] = range[1] = length3(term_axis(d));
        else
            distance_bound(d->receiver, d->emitter, range);
        d->terms.distance[0] = range[0];
        d->terms.distance[1] = range[1];
        d->terms.distance_level = (unsigned char)level;
    }
    return d->terms.distance;
}

#endif
