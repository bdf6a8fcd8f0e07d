/* bodies.h - convex solids of a few faces: what stands in shafts, where some make one.
 * SPDX-License-Identifier: MIT */
#ifndef BODIES_H
#define BODIES_H

#include "hierarchy/mates.h"

/* the most faces of a body: of more, outlines are found edge by edge */
enum { BODY_FACES = 32, BODY_CORNERS = 4 * BODY_FACES, BODY_EDGES = BODY_CORNERS, BODY_LIDS = 4 };

/* From a corner to another, by their places among the body's, and the sides at it, by theirs, lids
 * behind those with faces: the left one is on the left as seen from outside. */
struct body_edge {
    uint8_t from, to, left, right;
};

/* The plane of a side that a body has no face on, as it stands on something there; n looks out. */
struct body_lid {
    double n[3], at[3];
};

/* Where its parts begin in the lists of all bodies, and how many they are; of faces, one of each
 * side. */
struct body {
    uint32_t face, corner, edge, lid;
    uint8_t faces, corners, edges, lids;
};

struct bodies {
    uint32_t *of;    /* [built]: 1 more than the body that an element is a face of; 0: of none */
    double *covered; /* [built]: of a face's front, by bodies that stand on it (m2) */
    struct body *body;
    uint32_t *faces;
    double (*corners)[3];
    struct body_edge *edges;
    struct body_lid *lids;
};

/* Of a hierarchy with groups. Returns 0, or -1 when out of memory; close is fine then too. */
int bodies_open(struct bodies *bodies, const struct hierarchy *h, const struct mates *mates);
void bodies_close(struct bodies *bodies);

#endif
