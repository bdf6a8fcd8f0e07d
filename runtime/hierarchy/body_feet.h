/* body_feet.h - what convex solids stand on: of a body in the making, and of all of them.
 * SPDX-License-Identifier: MIT */
#ifndef BODY_FEET_H
#define BODY_FEET_H

#include "hierarchy/bodies.h"

/* An edge that nobody of the shell is across: of a face, from its corner to the next one. */
struct free_edge {
    int face, lid; /* -1: of none yet */
    const double *from, *to;
};

/* A body in the making. */
struct shell {
    const struct hierarchy *h;
    int faces, edges, lids;
    uint32_t face[BODY_FACES];
    struct free_edge edge[BODY_CORNERS];
    struct shell_lid {
        double corner[BODY_CORNERS][3], normal[3], area, around;
        int n;
    } lid[BODY_LIDS];
};

/* Are all lids covered, but for what is narrower than faces may reach off their planes? */
int body_feet_shut(const struct shell *shell);

/* Add what the next body stands on, with its lids and with faces of its own. Returns 0, or -1 when
 * out of memory. */
int body_feet_add(struct bodies *bodies, const struct shell *shell, const struct mates *mates,
                  uint32_t body);

/* Once all are there: how much of each face is covered; the list is put in order. */
void body_feet_sum(struct bodies *bodies, const struct hierarchy *h);

#endif
