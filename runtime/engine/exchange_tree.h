/* exchange_tree.h - the tree of elements that `viewfactors` refines: flat groups of faces between clusters and faces.
 * SPDX-License-Identifier: MIT */
#ifndef EXCHANGE_TREE_H
#define EXCHANGE_TREE_H

#include "hierarchy/hierarchy.h"
#include "visibility/rays.h"

/* A hierarchy whose groups of coplanar faces are surfaces: 4 vertices, the rectangle around them, and no face of their own
 * (GROUP_FACE, tools/group_level.h). Group or cluster, its faces are order[range.from .. range.to - 1]. */
struct exchange_tree {
    struct host host; /* first, so that a host is its tree: rays, and what stands in a shaft, by groups */
    struct hierarchy h;
    unsigned char *solid; /* [h.built]: 1: the element is a face, or a group whose faces tile its rectangle */
    struct rays *rays;
};

/* The faces are borrowed and must outlive the tree. Every face has B = 1 and reflects nothing.
 * Returns 0; on failure -1 with *cause set (a constant string) and nothing to free. */
int exchange_tree_open(struct exchange_tree *t, const struct face *faces, uint32_t face_count, int threads, const char **cause);
void exchange_tree_close(struct exchange_tree *t);

/* The faces below an element, parts of faces included. */
struct face_range exchange_tree_range(const struct exchange_tree *t, uint32_t element);

/* The face at a place in the tree's order. */
static inline const struct element *exchange_tree_face(const struct exchange_tree *t, uint32_t place)
{
    return &t->h.elements[t->h.face_element[t->h.order[place]]];
}

#endif
