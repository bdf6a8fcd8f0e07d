/* standalone.h - the two callbacks by which a program that ships a generated refiner describes itself.
 * dagc --standalone puts this into the generated header; within the project rays.c fills in the host.
 * SPDX-License-Identifier: MIT */
#ifndef STANDALONE_H
#define STANDALONE_H

#include "discussion.h"

/* The most segments that one call of `occluded` is given. */
enum { HOST_SEGMENTS = SEGMENTS_MAX };

/* Makes a host of its callbacks. `totals` is called once, here, to fill in the scene's
 * totals (area to importance), ray_offset and flat; `occluded` whenever a tool casts rays: bit i of what it returns says that segment i meets something.
 * To give them data of your own, let `host` be the first member of a structure of yours. */
static inline void host_open(struct host *host,
                             uint64_t (*occluded)(const struct host *host, int count, const struct segment *segments),
                             void (*totals)(struct host *host))
{
    host->occluded = occluded;
    host->area = host->extent = host->exitance = host->reflectance = host->irradiance = host->radiosity = 0;
    host->importance = 1;
    host->ray_offset = host->flat = 0;
    totals(host);
}

#endif
