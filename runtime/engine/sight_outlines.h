/* sight_outlines.h - what a point sees of a convex polygon past surfaces made of many faces, by
 * their outlines.
 * SPDX-License-Identifier: MIT */
#ifndef SIGHT_OUTLINES_H
#define SIGHT_OUTLINES_H

#include "engine/exchange_tree.h"
#include "engine/sight_faces.h"
#include "engine/sight_pieces.h"
#include "engine/sight_shadows.h"

/* What stands between a piece and the polygon it looks at. */
struct sight_between {
    int faces, edges;
    int bent;                  /* 1: a face is not in one plane, as outlines want them */
    uint32_t list[SIGHT_LIST]; /* ascending */
    struct sight_faces block[SIGHT_LIST / SIGHT_BOXED];
    uint16_t place[SIGHT_PLACES]; /* 1 more than it, of the last face of the list; 0: of none */
    struct sight_edge_block edge[SIGHT_EDGES / SIGHT_LINES];
};

enum between { BETWEEN_NOTHING, BETWEEN_ALL, BETWEEN_SOME, BETWEEN_MANY };

/* Of the faces list[count], ascending, among which are all that meet the shaft: what stands in it;
 * all: it is proved that every ray is stopped. near: none of them is far (shaft_far). */
enum between sight_between_open(struct sight_between *between, const struct exchange_tree *tree,
                                const struct shaft *shaft, const struct sight *sight,
                                const uint32_t *list, int count, int near);

/* sight_factor past what stands between. */
double sight_past(const struct sight *sight, const double x[3], const double n[3], double up,
                  const struct sight_between *between, double *whole);

#endif
