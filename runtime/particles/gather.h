/* gather.h - light at a point, gathered once more from a solution: what a picture shows of it.
 *
 * B(x) = E + rho integral B~(y) k(x, y) V(x, y) dA(y), of the solution B~, by rays from x. Errors
 * of B~ in detail, such as elements that are too large for a shadow, meet the picture only after
 * one more reflection, which is smooth. [Reichert 1992; Lischinski et al. 1993, section 6: local
 * pass]
 *
 * Half the rays look for what is bright, by points on it: emitters brighter than surfaces are in
 * the mean, and elements that reflect a few times as much, as beside a lamp. The others, spread by
 * the cosine, meet everything. What either finds counts by the balance heuristic [Veach and Guibas
 * 1995, section 3]; where all is equally bright there is no noise at all. Of an element that is
 * nearer than it is large, or that reflects so much, B~ is too coarse: what reaches that point is
 * gathered by some rays more, as the ray's second step. [Jensen 2001, section 9.3]
 *
 * Invariant: what is gathered at a point depends on the point, its set and its first ray alone.
 * SPDX-License-Identifier: MIT */
#ifndef GATHER_H
#define GATHER_H

#include "particles/sobol_sequence.h"
#include "particles/tracer.h"

struct gather {
    const struct tracer *tracer;        /* borrowed; its emitters are not looked at */
    const double *radiosity, *gradient; /* borrowed: as of RadElements; gradient NULL: constants */
    double mean;                        /* area mean of B~, sum of the bands */
    /* What is bright: [lights.face_count] elements, whole faces or leaves, seen as the faces of a
     * hierarchy of their own; lights.elements is borrowed */
    struct hierarchy lights;
    uint32_t *piece;        /* [elements]: of leaves, the bright thing they are of; or NO_PIECE */
    struct light_tree tree; /* over them */
    struct sobol_sequence sobol;
};

#define NO_PIECE UINT32_MAX

/* From a solution over the elements of t->hierarchy, the root's being the mean. Returns 0, or -1
 * when out of memory. */
int gather_open(struct gather *g, const struct tracer *t, const double *radiosity,
                const double *gradient);
void gather_close(struct gather *g);

/* B per band (W/m2) at a point of a face, by `count` rays and those of second steps. Points of one
 * set share one sequence of directions, spread evenly over all of them, in which the rays of this
 * one begin with number `first`. */
void gather_radiosity(const struct gather *g, uint32_t face, const double point[3], uint64_t set,
                      uint32_t first, uint32_t count, double *radiosity);

#endif
