/* replace_faces.h - faces of a scene in the places of others.
 * SPDX-License-Identifier: MIT */
#ifndef REPLACE_FACES_H
#define REPLACE_FACES_H

#include "hierarchy/scene.h"

/* What stands for a face, and for its far side if it is the front of a pair; none where count is 0.
 */
struct replacement {
    uint32_t face; /* first: replacements are sorted by it */
    size_t count;
    const struct face *by; /* [count], borrowed */
};

/* Each face of the list is replaced, all others stay, in their order. The list, in any order, is
 * sorted by its faces. Returns 0, or -1 when out of memory, and the scene is as it was. */
int replace_faces(struct scene *scene, struct replacement *list, size_t count);

#endif
