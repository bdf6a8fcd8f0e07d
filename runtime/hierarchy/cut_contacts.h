/* cut_contacts.h - the segments in which other faces meet or cross a face's plane.
 * SPDX-License-Identifier: MIT */
#ifndef CUT_CONTACTS_H
#define CUT_CONTACTS_H

#include "hierarchy/hierarchy.h"

/* A face with a frame in its plane, and what counts as near in it. */
struct cut_frame {
    const struct face *face;
    uint32_t index;
    int two_sided;                           /* its far side is the face behind it */
    double size;                             /* its longest diagonal (m) */
    double touch;                            /* nearer than that is the same place (m) */
    double centre[3], normal[3], u[3], v[3]; /* u along the longest edge */
    double low[3], high[3];
};

struct contact {
    /* of its line: direction about the normal from u, in [0, pi); distance from the centre (m) */
    double angle, offset;
    double from, to; /* along the direction (m) */
    uint32_t face;
};

struct contact_list {
    struct contact *contacts; /* [count] */
    size_t count, capacity;
};

/* The frame of faces[index]. Returns 0 when the face has no area to cut. */
int cut_frame_of(struct cut_frame *frame, const struct face *faces, uint32_t index, int two_sided,
                 double precision);

/* Distance of a point from the centre along a direction (m). */
double cut_distance(const struct cut_frame *frame, const double p[3], const double direction[3]);

/* Does a line leave more than a sliver of the polygon on both sides? */
int cut_parts_polygon(const struct cut_frame *frame, const double (*v)[3], uint32_t n,
                      const double across[3], double offset);

/* The box of the normals of all faces below each node, [tree->count], to be freed; NULL when out of
 * memory. */
struct bounds *contacts_normals(const struct face *faces, const struct bvh *tree);

/* Make the list hold the contacts of all faces in the tree with the frame's; normals: of this tree.
 * Returns 0, or -1 when out of memory. */
int contacts_collect(struct contact_list *list, const struct cut_frame *frame,
                     const struct face *faces, const struct bvh *tree,
                     const struct bounds *normals);

#endif
