/* longer.h - question: which element has the larger diameter: the longest distance between corners,
 * of a cluster its box's diagonal (m)? Slivers have little area for their length, and it is the
 * length that makes estimates fail. Equal diameters are told apart by identity, so that a pair
 * splits the same element both ways round. [D: derived here]
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_LONGER_H
#define TOOL_LONGER_H

#include "discussion.h"

/* Square of the element's diameter (m2). */
static inline double longer_square(const struct element *e)
{
    double most = 0, v[3];
    int n = e->vertices ? e->vertices : 2;
    for (int i = 1; i < n; i++)
        for (int j = 0; j < i; j++) {
            sub3(v, e->vertex[i], e->vertex[j]);
            most = dot3(v, v) > most ? dot3(v, v) : most;
        }
    return most;
}

TOOL enum longer_answer tool_longer(struct discussion *d)
{
    const struct element *r = d->receiver, *s = d->emitter;
    double a = longer_square(r), b = longer_square(s);
    return a > b || (a == b && r->id <= s->id) ? LONGER_RECEIVER : LONGER_EMITTER;
}

#endif
