/* light_ranges.h - for each leaf, which share of what any of its points sees can be whose.
 * SPDX-License-Identifier: MIT */
#ifndef LIGHT_RANGES_H
#define LIGHT_RANGES_H

#include "engine/operator.h"

/* An emitter that points x of the leaf may see: F(x) in [low, high], nothing between. 24 bytes. */
struct share {
    uint32_t emitter; /* element; no two of a leaf share a point */
    float low, high;
    float linked;                     /* V of the link that holds the pair; 0: there is none */
    float weight;                     /* of whoever allots (light_bounds.c) */
    uint32_t group : 31, visible : 1; /* 1 + its face's, 0: none; proved that nothing is between */
};

/* F(x) of a face whose parts are emitters of their own: their shares sum to it. */
struct share_group {
    float low, high;
    uint32_t visible; /* all parts are */
};

struct share_row {
    struct share *shares; /* [share_count] */
    struct share_group *groups;
    uint32_t share_count, group_count;
};

struct light_ranges {
    const struct light_operator *op;
    struct share_row *rows; /* [elements]; of uncovered leaves, others have none */
    unsigned char *closed;  /* [elements]: 1: proved that the leaf sees fronts alone (winding.h) */
    uint64_t count;         /* shares */
    int too_many;           /* more than RANGES_MOST: there are none */
};

enum { RANGES_MOST = 6000000 };

/* Called from the calling thread alone; nonzero stops. */
typedef int ranges_watch(void *context, uint64_t leaves_done, uint64_t shares);

/* Ranges for all uncovered leaves. most, spread: of B below each element [element], the largest and
 * that less the smallest, each in the band where it is largest; by them it is decided how far to
 * look. Returns 0, or -1 when out of memory or stopped. */
int light_ranges_open(struct light_ranges *r, const struct light_operator *op, const double *most,
                      const double *spread, ranges_watch *watch, void *context);
void light_ranges_close(struct light_ranges *r);

#endif
