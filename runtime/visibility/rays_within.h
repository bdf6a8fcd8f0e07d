/* rays_within.h - what a scene's rays are made of, for the files that cast them: rays.c,
 * ray_hits.c.
 * SPDX-License-Identifier: MIT */
#ifndef RAYS_WITHIN_H
#define RAYS_WITHIN_H

#include "util/embree.h"
#include "visibility/free_space.h"
#include "visibility/rays.h"

/* A segment is six numbers; those of a group fill whole vectors. */
enum { GROUP = 4, NUMBERS = 6, STEP = GROUP * NUMBERS };

struct rays {
    struct host host;                  /* first, so that a host is its rays */
    const struct hierarchy *hierarchy; /* borrowed */
    RTCDevice device;
    RTCScene scene;
    double origin[3], scale;      /* Embree's coordinates: (x - origin) * scale */
    double origins[STEP];         /* the origin, again and again */
    uint32_t *face;               /* by Embree's primitive: its front */
    uint32_t *behind;             /* by face: what is met from behind (back_faces.h) */
    _Atomic unsigned char *stood; /* by face: STOOD_ON (rays.c); 0: not asked yet */
    struct free_space free;       /* what passes it by needs no ray */
    int threads;
    struct tally *tallies; /* [threads] */
};

#endif
