/* group_outline.h - the outline of a group of coplanar faces: a polygon of 3 or 4 corners.
 * SPDX-License-Identifier: MIT */
#ifndef GROUP_OUTLINE_H
#define GROUP_OUTLINE_H

#include "hierarchy/hierarchy.h"
#include "hierarchy/places.h"

struct outliner {
    const struct hierarchy *plain; /* measured face elements */
    double flat;                   /* m */
    double (*points)[2], (*hull)[2];
    struct directed *edges;
    struct corner *corners;
    uint32_t *place; /* of the corners */
};

/* The frame of a plane, along the smallest rectangle around its faces. */
struct group_frame {
    double origin[3], u[3], v[3], n[3];
    int full; /* the faces fill that rectangle */
};

/* Some faces of a hierarchy. */
struct group_faces {
    const uint32_t *face;
    uint32_t count;
};

/* Returns 0, or -1 when out of memory; to be closed in both cases. */
int outliner_open(struct outliner *o, const struct hierarchy *plain, double flat);
void outliner_close(struct outliner *o);

void group_frame_of(struct outliner *o, struct group_faces faces, struct group_frame *frame);
void group_bounds(const struct outliner *o, const struct group_frame *frame,
                  struct group_faces faces, double low[2], double high[2]);

/* Sets corners, normal, centre, radius and area of a group's element. */
void group_outline(struct outliner *o, const struct group_frame *frame, struct group_faces faces,
                   struct element *e);

/* Have the faces the area of the outline that e has? All parts of a polygon tile it then: they do
 * not lie on each other (overlaps.h). */
int group_fills(const struct group_frame *frame, const struct element *e);

/* Do any faces tile the outline that e has? */
int group_tiles(struct outliner *o, const struct group_frame *frame, struct group_faces faces,
                const struct element *e);

#endif
