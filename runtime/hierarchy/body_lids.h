/* body_lids.h - a body in the making, and the sides that it has no face on.
 * SPDX-License-Identifier: MIT */
#ifndef BODY_LIDS_H
#define BODY_LIDS_H

#include <string.h>
#include "hierarchy/bodies.h"

/* An edge that nobody of the shell is across: of a face, from its corner to the next one. */
struct free_edge {
    int face, lid; /* -1: of none yet */
    const double *from, *to;
};

/* Lids that meet at an edge of their own: from a corner to another, which the left one has on its
 * left as seen from outside. */
struct lid_joint {
    double from[3], to[3];
    int left, right;
};

/* Sides are faces, of each plane one at least, and all if they are few. */
struct shell {
    const struct hierarchy *h;
    int faces, sides, edges, lids, joints;
    const uint32_t *face, *side; /* [faces], [sides]: borrowed */
    struct free_edge edge[BODY_CORNERS];
    struct shell_lid {
        double corner[BODY_CORNERS][3], normal[3], area, around;
        int n;
    } lid[BODY_LIDS];
    struct lid_joint joint[BODY_LIDS];
};

/* As large as an element; its area and length are not asked. */
static inline void shell_lid_of(struct shell_lid *lid, const struct element *e)
{
    lid->n = e->vertices;
    memcpy(lid->corner, e->vertex, (size_t)e->vertices * sizeof *e->vertex);
    memcpy(lid->normal, e->normal, sizeof lid->normal);
}

/* Is a side flat, and does no corner of the shell lie in front of its plane, and some behind by
 * more than rounding? Else points in the plane of a plate were inside. */
int body_lids_supports(const struct shell *s, const double (*v)[3], int n, const double normal[3]);

/* The lids, from the free edges. Returns 0 when these go around none. */
int body_lids_find(struct shell *s);

#endif
