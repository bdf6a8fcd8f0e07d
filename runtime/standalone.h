/* standalone.h - the callbacks by which a program that ships a generated refiner describes itself.
 * dagc --standalone puts this into the generated header; within the project rays.c fills in the
 * host.
 *
 * Two are needed, those of host_open. The others may be left NULL; a graph that asks about shafts
 * is answered too_complex then, and extinction takes nothing away. To have them, set
 * host.candidates and host.corners (both or neither), and host.optical_depth, after host_open.
 * candidates is given planes and a box: a face may be left out when all its corners lie outside the
 * box, or beyond one plane, normal . p > offset + reach; the refiner looks at the others more
 * closely itself. Let discussion.blockers point at a structure that lives as long as the
 * discussion; with `known` 0 nothing is inherited, and BLOCKERS_INHERITED says that it holds the
 * list of a pair of which these two elements are parts.
 * SPDX-License-Identifier: MIT */
#ifndef STANDALONE_H
#define STANDALONE_H

#include "discussion.h"

/* The most segments that one call of `occluded` is given. */
enum { HOST_SEGMENTS = SEGMENTS_MAX };

/* Makes a host of its callbacks. `totals` is called once, here, to fill in the scene's
 * totals (area to importance; impact and rank where they are not 1 and 0), ray_offset and flat;
 * `occluded` whenever a tool casts rays: bit i of what it returns says that segment i meets
 * something. To give them data of your own, let `host` be the first member of a structure of
 * yours. */
static inline void host_open(struct host *host,
                             uint64_t (*occluded)(const struct host *host, int count,
                                                  const struct segment *segments),
                             void (*totals)(struct host *host))
{
    host->occluded = occluded;
    host->area = host->extent = host->exitance = host->reflectance = host->irradiance =
        host->radiosity = 0;
    host->importance = host->impact = host->mean_reflectance = 1;
    host->rank = 0;
    host->ray_offset = host->flat = 0;
    host->candidates = NULL;
    host->exact = 0;
    host->corners = NULL;
    host->optical_depth = NULL;
    totals(host);
}

#endif
