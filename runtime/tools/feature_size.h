/* feature_size.h - question: is the umbra that the emitter leaves on the receiver smaller than
 * `min` (m)?
 *
 * Source of width S, blocker of width C parallel to it at the distance t, receiver at the distance
 * D from the source. The line from one border of the source through the blocker's border on the
 * same side lies, off the middle axis, at S/2 + (C/2 - S/2) z/t, where z is the distance from the
 * source: similar triangles. At z = D, twice that is the width of the umbra, f = S + (D/t)(C - S).
 * It is negative where a larger source shines round the blocker, and there is no umbra at all;
 * then, and when nothing stands in the shaft, the answer is small. A width is the least of the
 * polygon, between two parallel lines; t is measured along the line of centres to the middle of the
 * blocker's part in the shaft. Of several blockers the one with the largest umbra counts. [Sillion
 * & Drettakis 1995, section 5; geometry derived here]
 * Fails: blockers that make a shadow together, surfaces that are not parallel; too_complex: more
 * than 8 faces, clusters, a host without candidates.
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_FEATURE_SIZE_H
#define TOOL_FEATURE_SIZE_H

#include "discussion.h"
#include "kernel/constants.h"
#include "terms/blockers.h"

/* The least distance of two parallel lines that hold the polygon between them; one runs along an
 * edge. */
static inline double feature_size_width(const double (*v)[3], int n)
{
    double least = INFINITY;
    for (int i = 0; i < n; i++) {
        double e[3], w[3], c[3], most = 0;
        sub3(e, v[i + 1 < n ? i + 1 : 0], v[i]);
        double length = length3(e);
        for (int j = 0; j < n && length > 0; j++) {
            sub3(w, v[j], v[i]);
            cross3(c, e, w);
            double across = length3(c) / length;
            most = across > most ? across : most;
        }
        least = length > 0 && most < least ? most : least;
    }
    return least;
}

/* The largest f, -INFINITY when there is no blocker (m). */
OUTLINE double feature_size_largest(const struct element *r, const struct element *s,
                                    const struct host *host, const struct blockers *list)
{
    double axis[3], source = feature_size_width((const double(*)[3])s->vertex, s->vertices),
                    largest = -INFINITY;
    sub3(axis, r->centre, s->centre);
    double distance = length3(axis);
    struct shaft shaft;
    if (list->count == 0 || !(distance > 0) || !shaft_open(&shaft, r, s, host))
        return largest;
    for (int i = 0; i < list->count; i++) {
        struct polygon face;
        double along = 0, w[3];
        host->corners(host, list->face[i], &face);
        struct cut inside;
        if (!shaft_meets(&shaft, (const double(*)[3])face.v, face.n, &inside))
            continue;
        for (int j = 0; j < inside.n; j++) {
            sub3(w, inside.v[j], s->centre);
            along += dot3(w, axis) / (distance * distance * inside.n); /* t / D */
        }
        along = along < FEATURE_SIZE_NEAREST ? FEATURE_SIZE_NEAREST : along < 1 ? along : 1;
        double f =
            source + (feature_size_width((const double(*)[3])face.v, face.n) - source) / along;
        largest = f > largest ? f : largest;
    }
    return largest;
}

TOOL enum feature_size_answer tool_feature_size(struct discussion *d, double min)
{
    struct blockers own;
    const struct blockers *list = blockers_list(d, &own);
    if (list->count > BLOCKERS_MAX)
        return FEATURE_SIZE_TOO_COMPLEX;
    return feature_size_largest(d->receiver, d->emitter, d->host, list) < min ? FEATURE_SIZE_SMALL
                                                                              : FEATURE_SIZE_BIG;
}

#endif
