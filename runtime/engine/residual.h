/* residual.h - how far the radiosity of a leaf is from what its links would give at single points
 * of it.
 * SPDX-License-Identifier: MIT */
#ifndef RESIDUAL_H
#define RESIDUAL_H

#include "engine/operator.h"

/* The discretization residual of a leaf (W/m2), the band where it is largest. */
struct leaf_residual {
    double all;     /* of all its links, its ancestors' among them */
    double guarded; /* of those alone that a guard kept from being split (LINK_GUARDED) */
    uint32_t links; /* how many it has */
};

/* With B = radiosity[element * bands + band], of which the separable links were last sent.
 * Thread-safe. */
struct leaf_residual residual_of_leaf(const struct light_operator *op, const double *radiosity,
                                      uint32_t leaf);

/* Points of a leaf, and what links would bring to each less what they bring to the leaf (W/m2). */
enum { RESIDUAL_POINTS = 9 };
struct residual_points {
    double at[RESIDUAL_POINTS][3]; /* [count] */
    int count;
    /* [element]: largest less smallest B below it; emitters that bring more than `detail` (W/m2)
     * of it are taken by parts. NULL: emitters are what their links say */
    const double *spread;
    double detail;
    double sum[2][RESIDUAL_POINTS]
              [3]; /* [band]; [1]: of links that a guard kept whole, [0] others */
};

/* Set p->at and p->count: the leaf's corners, a little within, then its centre. */
void residual_corners(const struct element *leaf, struct residual_points *p);

/* Set p->sum. Returns how many links there are. Thread-safe. */
uint32_t residual_at_points(const struct light_operator *op, const double *radiosity, uint32_t leaf,
                            struct residual_points *p);

#endif
