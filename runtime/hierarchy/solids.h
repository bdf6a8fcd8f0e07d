/* solids.h - convex solids of any number of faces: which of them a face is part of.
 * SPDX-License-Identifier: MIT */
#ifndef SOLIDS_H
#define SOLIDS_H

#include "hierarchy/mates.h"

struct solids {
    /* [built]: 1 more than the solid that all faces of an element are of; 0: of none, or several */
    uint32_t *of;
    uint32_t count;
    uint32_t *by_normal, places; /* faces of solids, 1 more, by their normals' digits; so many */
};

/* Of a hierarchy with groups. Returns 0, or -1 when out of memory; close is fine then too. */
int solids_open(struct solids *solids, const struct hierarchy *h, const struct mates *mates);
/* A solid, 1 more than it, that lies wholly behind the plane of these points, but for `most` (m);
 * 0: none is known to. One is where n is to the last digit the normal of one of its faces. */
uint32_t solids_behind(const struct solids *solids, const struct hierarchy *h, const double n[3],
                       const double (*points)[3], int count, double most);
void solids_close(struct solids *solids);

#endif
