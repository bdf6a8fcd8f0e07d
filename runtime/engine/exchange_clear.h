/* exchange_clear.h - the exchange areas of pairs of faces that see all of each other.
 * SPDX-License-Identifier: MIT */
#ifndef EXCHANGE_CLEAR_H
#define EXCHANGE_CLEAR_H

#include "engine/clear_points.h"
#include "engine/exchange_tree.h"

/* Blocks are no larger than that on a side, so that a column's values are in the cache while its
 * neighbours' rows are written. */
enum { TILE = 64 };

enum { MOMENTS = 6 }; /* xx yy zz xy xz yz */

/* The faces, as the kernel wants them: [faces] each, in the tree's order. */
struct exchange_faces {
    double *c[3], *area;     /* centroid, m2 */
    double *lopsided;        /* how large third moments are: 0 to 1 */
    double *moment[MOMENTS]; /* mean of d d over the face, d from the centroid (m2) */
    double *all;             /* where they stand */
    unsigned char *covered;  /* 1: solids stand on all of it, so that it sees nothing */
    struct clear_rule rules[2];
};

/* Returns 0, or -1 when out of memory; close is fine then too. */
int exchange_faces_open(struct exchange_faces *faces, const struct exchange_tree *tree);
void exchange_faces_close(struct exchange_faces *faces);

/* Two linked elements of the tree, and which of the receiver's faces (rows) and of the emitter's
 * (columns) a block holds, by place in the tree's order. */
struct exchange_pair {
    const struct exchange_tree *tree;
    const struct element *receiver, *emitter;
    struct face_range rows, columns;
};

/* Do two faces lie on each other, one of a solid's (bodies_meet)? */
int clear_meet(const struct exchange_tree *tree, const struct element *a, const struct element *b);

/* out[rows][columns]: A_i F_ij (m2) if nothing stands between the two groups, none above the
 * smaller area; within `tolerance` of itself, or of SIGHT_FLOOR of the smaller area. */
void clear_block(const struct exchange_faces *faces, const struct exchange_pair *pair,
                 double tolerance, double *out);

/* One of its lines, to the same bits: out[columns], the row of the face at that place in the tree's
 * order; `column`: out[rows], its column. */
void clear_line(const struct exchange_faces *faces, const struct exchange_pair *pair,
                double tolerance, uint32_t place, int column, double *out);

#endif
