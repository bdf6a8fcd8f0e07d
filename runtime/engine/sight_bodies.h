/* sight_bodies.h - convex solids in the coordinates of the plane that their shadows are cast on.
 * SPDX-License-Identifier: MIT */
#ifndef SIGHT_BODIES_H
#define SIGHT_BODIES_H

#include "engine/exchange_tree.h"
#include "engine/sight_pieces.h"
#include "kernel/lanes.h"

/* the most of a list, and of all their corners, planes and edges */
enum {
    SIGHT_BODIES = 64,
    SIGHT_BODY_CORNERS = 512,
    SIGHT_BODY_PLANES = 512,
    SIGHT_BODY_EDGES = 1024
};

/* Corners and planes, n . p - c, in the coordinates of the plane that shadows are cast on; edges by
 * them, each body's beginning where the last one's end. Rounded up to whole lanes. */
struct sight_bodies {
    int count, corners, planes, edges;
    struct sight_body {
        int corner, plane, edge; /* where its own begin */
        int foot;                /* 1: the plane runs through it, or it stands on that */
    } body[SIGHT_BODIES + 1];
    double corner[3][SIGHT_BODY_CORNERS], plane[4][SIGHT_BODY_PLANES];
    struct sight_body_edge {
        int16_t left, right; /* planes of the two faces that it is of */
    } edge[SIGHT_BODY_EDGES];
    double end[2][3][SIGHT_BODY_EDGES + LANES_MOST]; /* the corners of edges */
};

/* Of the bodies that the faces of a list are part of. Returns 0 when there are too many, or a face
 * is of none. */
int sight_bodies_place(struct sight_bodies *bodies, const struct exchange_tree *tree,
                       const uint32_t *list, int count, const struct outline_frame *frame);

#endif
