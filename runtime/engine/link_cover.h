/* link_cover.h - which link brings light from one leaf to another?
 *
 * Pairs are refined from (root, root) on, so at most one link has the one leaf in its receiver and
 * the other in its emitter. While one goes through the receivers, each marks the emitters of its
 * links, each link once; on the way up from a leaf the first mark is that of the link.
 * [derived here]
 * SPDX-License-Identifier: MIT */
#ifndef LINK_COVER_H
#define LINK_COVER_H

#include "engine/operator.h"

struct link_cover {
    const struct light_operator *op; /* borrowed */
    /* [elements], by emitter: 0: no link; 2 (i + 1): link i, of surfaces; 2 (i + 1) + 1: separable
     * link i */
    size_t *mark;
    uint32_t top; /* the cluster whose links, and those of all above it, are marked */
};

/* The link that was found. */
struct covering {
    enum RadWay way;
    const struct link *link; /* RAD_WAY_OPEN, RAD_WAY_HALF: it */
    size_t group;            /* RAD_WAY_GROUPS: the separable link */
};

/* The root's links are marked. Returns 0, or -1 when out of memory. */
int link_cover_open(struct link_cover *c, const struct light_operator *op);
void link_cover_close(struct link_cover *c);

/* Have the links of a cluster marked and of all above it, and of no other cluster. */
void link_cover_move(struct link_cover *c, uint32_t cluster);
/* Mark the links of element e, 1, or unmark them, 0. */
void link_cover_mark(struct link_cover *c, uint32_t e, int marked);

/* By which of the links that are marked the light of an element comes. */
struct covering link_cover_find(const struct link_cover *c, uint32_t emitter);

static inline int link_is_separable(const struct hierarchy *h, const struct link *l)
{
    return !h->elements[l->receiver].vertices || !h->elements[l->emitter].vertices;
}

/* Of a link between surfaces that brings something. */
static inline enum RadWay link_way(const struct link *l)
{
    return l->visibility == LINK_VISIBLE ? RAD_WAY_OPEN : RAD_WAY_HALF;
}

#endif
