/* sight_between.h - what stands between a piece and the polygon that it looks at: faces, and those
 * of their edges that may be an outline from a point of the piece.
 * SPDX-License-Identifier: MIT */
#ifndef SIGHT_BETWEEN_H
#define SIGHT_BETWEEN_H

#include "engine/exchange_tree.h"
#include "engine/sight_faces.h"
#include "engine/sight_pieces.h"
#include "engine/sight_shadows.h"

/* An edge that may be an outline: from this corner of a face of the list on; the face across it,
 * which is -1 where the list has none. */
struct sight_rim {
    int16_t at, mate;
    int8_t corner, turned; /* turned: the other face has its front where this one has its back */
};

struct sight_between {
    int faces, rims, edges;       /* edges: rims, and feet in the plane */
    int loose;                    /* of the edges: outlines from anywhere */
    int bent;                     /* 1: a face is not in one plane, as outlines want them */
    double flat;                  /* how far off a plane a face may be that is in it (m) */
    uint32_t list[SIGHT_LIST];    /* ascending */
    uint16_t place[SIGHT_PLACES]; /* 1 more than it, of the last face of the list; 0: of none */
    struct sight_rim rim[SIGHT_EDGES];
    struct sight_faces block[SIGHT_LIST / SIGHT_BOXED];
    struct sight_edge_block edge[SIGHT_EDGES / SIGHT_LINES];
    /* a point's: lists of edges, each shorter than the one before (sight_outlines.c) */
    uint16_t cuts[SIGHT_EDGES * (SIGHT_EDGES + 3) / 2];
};

enum between { BETWEEN_NOTHING, BETWEEN_ALL, BETWEEN_SOME, BETWEEN_MANY };

/* Of the faces list[count], ascending, among which are all that meet the shaft: those that do.
 * nothing and all are proved: no ray is stopped, every ray is. near: none of the list is far
 * (shaft_far). */
enum between sight_between_find(struct sight_between *between, const struct exchange_tree *tree,
                                const struct shaft *shaft, const uint32_t *list, int count,
                                int near);
/* Of some, where shadows are cast on. Returns -1 when there are too many. */
int sight_between_place(struct sight_between *between, const struct exchange_tree *tree,
                        const struct sight *sight);

static inline int sight_between_blocks(const struct sight_between *b)
{
    return (b->faces + SIGHT_BOXED - 1) / SIGHT_BOXED;
}

#endif
