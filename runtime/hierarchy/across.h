/* across.h - who stands across an edge of a face, stretch by stretch: edges need not be equal.
 * SPDX-License-Identifier: MIT */
#ifndef ACROSS_H
#define ACROSS_H

#include "hierarchy/hierarchy.h"

/* faces that touch an edge, at the most: of more nothing is known */
enum { ACROSS_FACES = 128, ACROSS_STRETCHES = 2 * ACROSS_FACES + 1 };
#define ACROSS_NOBODY UINT32_MAX

/* A stretch of an edge, along which the edge runs. Across it stands a face, an element without
 * children that has a solid between it and the one that is asked about, behind both. */
struct across {
    uint32_t face;
    const double *from, *to;
};

/* Of the edge from a corner of a face to the next, in a hierarchy with groups. Returns how many
 * stretches, one after the other; 0: not known. */
int across_edge(const struct hierarchy *h, uint32_t face, int side,
                struct across list[ACROSS_STRETCHES]);

#endif
