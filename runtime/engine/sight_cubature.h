/* sight_cubature.h - what one face exchanges with another past what stands between, by points of
 * the one, and how far that may be wrong.
 * SPDX-License-Identifier: MIT */
#ifndef SIGHT_CUBATURE_H
#define SIGHT_CUBATURE_H

#include "engine/exchange_tree.h"
#include "engine/face_rule.h"
#include "engine/sight_limits.h"

/* One thread's room, for the pieces of a pair. */
struct sight_scratch {
    struct sight_node *nodes;
    uint32_t *lists; /* limits.list for each node */
    int *heap;
    struct sight_between *between;
    struct sight_bodies *bodies;
    struct sight_known *known; /* of all pairs so far */
    struct face_fit fit[2];    /* of triangles, of quads */
    struct sight_limits limits;
};

/* Returns 0, or -1 when out of memory; close is fine then too. */
int sight_scratch_open(struct sight_scratch *scratch, const struct sight_limits *limits);
void sight_scratch_close(struct sight_scratch *scratch);

/* Two faces, or parts of faces; the points are on `from`. All are borrowed. */
struct sight_ends {
    const struct exchange_tree *tree;
    const struct element *from, *to;
    double clear;         /* what they exchange with nothing between (m2) */
    const uint32_t *list; /* [count], ascending: faces among which are all that stand between */
    int count;            /* SIGHT_LIST + 1: they are not known, and the list is not read */
    int found;            /* 1: sight_between_find has left in scratch->between those that do */
    int believes;         /* 1: in rules that tell enough */
    uint32_t on;          /* the element that `from` is, or is part of */
    int joined;           /* 1: a solid that stands on `from` touches `to`, or holds it */
};

/* A F from the one to the other (m2); *error: the error estimated (m2). */
double sight_integrate(const struct sight_ends *ends, struct sight_scratch *scratch, double *error);

/* What the best quadratic leaves of what is hidden from points that see this share, of `clear` with
 * nothing between (m2). */
double sight_rest(const struct face_fit *fit, const double *seen, const double *whole, double share,
                  double clear);

#endif
