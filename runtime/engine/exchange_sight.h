/* exchange_sight.h - the exchange area of two faces, or parts of faces, past what stands between
 * them, and how far it may be wrong.
 * SPDX-License-Identifier: MIT */
#ifndef EXCHANGE_SIGHT_H
#define EXCHANGE_SIGHT_H

#include "engine/exchange_tree.h"
#include "engine/face_rule.h"
#include "engine/sight_limits.h"
#include "engine/sight_lists.h"

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

/* What the best quadratic leaves of what is hidden from points that see this share, of `clear` with
 * nothing between (m2). */
double sight_rest(const struct face_fit *fit, const double *seen, const double *whole, double share,
                  double clear);

/* A_r F_rs (m2), no more than if nothing stood between; *error: the error estimated (m2). `among`:
 * of a pair that holds this one; NULL: nobody has looked. `again`: of a row that did not add up, so
 * rules that tell enough are not believed. */
double sight_pair(const struct element *r, const struct element *s,
                  const struct exchange_tree *tree, const struct sight_list *among,
                  struct sight_scratch *scratch, int again, double *error);

#endif
