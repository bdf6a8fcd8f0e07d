/* bodies.h - convex solids of a few faces: what stands in shafts, where some make one.
 * SPDX-License-Identifier: MIT */
#ifndef BODIES_H
#define BODIES_H

#include "hierarchy/mates.h"
#include "kernel/constants.h"

/* the most faces of a body: of more, outlines are found edge by edge */
enum { BODY_FACES = 32, BODY_CORNERS = 4 * BODY_FACES, BODY_EDGES = BODY_CORNERS, BODY_LIDS = 4 };

/* a share of a face that is rounding, as of corners of nine digits; chosen: what a group's outline
 * may be off by */
#define BODY_WHOLLY GROUP_GAPS

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

/* A body stands on the front of a face, an element, on so much of it (m2); with a face of its own,
 * UINT32_MAX where it has none there. Of body BODY_NONE: the face lies there, and one of the two is
 * of something solid, that is no body (body_contacts.h). */
enum { BODY_NONE = INT32_MAX };
struct body_foot {
    uint32_t on, body, face;
    double area;
};

struct bodies {
    /* [built]: 1 more than the body that an element is a face of, 0: of none: of what stands in
     * shafts, and of faces, too, that are in a group with others */
    uint32_t *of, *whose;
    double *covered; /* [built]: of a face's front, by bodies that stand on it (m2) */
    double *shut;    /* [built]: of that, what bodies have a face on, which light meets (m2) */
    struct body_foot *feet; /* [feet_count]: ascending by `on`, then by the body */
    size_t feet_count, feet_room;
    uint32_t *loose; /* [loose_count]: faces, but back sides, that others lie on, most of no body */
    size_t loose_count;
    struct body *body;
    uint32_t *faces;
    double (*corners)[3];
    struct body_edge *edges;
    struct body_lid *lids;
};

/* Of a hierarchy with groups. Returns 0, or -1 when out of memory; close is fine then too. */
int bodies_open(struct bodies *bodies, const struct hierarchy *h, const struct mates *mates);
void bodies_close(struct bodies *bodies);

/* Is a point that is a little above the front of an element in something solid that stands on it
 * with a face? Nothing sees it. */
int bodies_hold(const struct bodies *bodies, const struct hierarchy *h, uint32_t element,
                const double p[3]);

/* Does a body that stands on it with a face touch another element, which looks into it there, but
 * for so much (m), or hold some of it? Something solid that is no body may wherever the other one
 * touches any, or is over where it stands. */
int bodies_join(const struct bodies *bodies, const struct hierarchy *h, uint32_t element,
                const struct element *other, double near);

/* Is one of two faces of something solid that stands on the other, or that this lines? They lie on
 * each other, and what rounding puts between them is no gap. */
int bodies_meet(const struct bodies *bodies, const struct hierarchy *h, uint32_t one,
                uint32_t other);

/* Do faces of bodies lie on all of its front, but for rounding? */
static inline int bodies_cover(const struct bodies *bodies, const struct hierarchy *h,
                               uint32_t element)
{
    return bodies->shut[element] > (1 - BODY_WHOLLY) * h->elements[element].area;
}

#endif
