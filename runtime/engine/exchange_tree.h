/* exchange_tree.h - the elements between which exchange areas are found: a hierarchy with flat
 * groups, and a host over it.
 * SPDX-License-Identifier: MIT */
#ifndef EXCHANGE_TREE_H
#define EXCHANGE_TREE_H

#include "hierarchy/bodies.h"
#include "hierarchy/group_hierarchy.h"
#include "hierarchy/solids.h"
#include "visibility/rays.h"

struct exchange_tree {
    /* first, so that a host is its tree: rays, and what stands in a shaft, by groups */
    struct host host;
    double lift; /* how far off their faces points look from past others (m): no ray is cast */
    struct hierarchy h;
    struct mates mates; /* of what stands in shafts */
    struct bodies bodies;
    struct solids solids;
    /* not built where nothing is in the way: who asks what they meet builds them before */
    struct rays *rays;
    struct hierarchy plain; /* what they are built of; empty when they are */
};

/* The faces are borrowed and must outlive the tree. Every face has B = 1 and reflects nothing.
 * Returns 0; on failure -1 with *cause set (a constant string) and nothing to free. */
int exchange_tree_open(struct exchange_tree *t, const struct face *faces, uint32_t face_count,
                       int threads, const char **cause);
void exchange_tree_close(struct exchange_tree *t);

/* The face at a place in the tree's order. */
static inline const struct element *exchange_tree_face(const struct exchange_tree *t,
                                                       uint32_t place)
{
    return hierarchy_surface(&t->h, t->h.order[place]);
}

#endif
