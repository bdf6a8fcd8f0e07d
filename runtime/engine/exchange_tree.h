/* factor_tree.h - the tree of elements that `viewfactors` refines: flat groups of faces between clusters and faces.
 * SPDX-License-Identifier: MIT */
#ifndef FACTOR_TREE_H
#define FACTOR_TREE_H

#include "hierarchy/hierarchy.h"
#include "visibility/rays.h"

/* A hierarchy whose groups of coplanar faces are surfaces: 4 vertices, the rectangle around them, and no face of their own
 * (GROUP_FACE, tools/group_level.h). Group or cluster, its faces are order[range.from .. range.to - 1]. */
struct factor_tree {
    struct host host; /* first, so that a host is its tree: rays, and what stands in a shaft, by groups */
    struct hierarchy h;
    unsigned char *solid; /* [h.built]: 1: the element is a face, or a group whose faces tile its rectangle */
    struct rays *rays;
};

/* The faces are borrowed and must outlive the tree. Every face has B = 1 and reflects nothing.
 * Returns 0; on failure -1 with *cause set (a constant string) and nothing to free. */
int factor_tree_open(struct factor_tree *t, const struct face *faces, uint32_t face_count, int threads, const char **cause);
void factor_tree_close(struct factor_tree *t);

/* The faces below an element, parts of faces included. */
struct face_range factor_tree_range(const struct factor_tree *t, uint32_t element);

#endif
