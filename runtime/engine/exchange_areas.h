/* exchange_areas.h - the matrix of exchange areas, in blocks. What A_i F_ij is, once for both ways.
 * SPDX-License-Identifier: MIT */
#ifndef EXCHANGE_AREAS_H
#define EXCHANGE_AREAS_H

#include "engine/exchange_tree.h"
#include "engine/refine.h"
#include "hierarchy/scene.h"

/* Faces stand in the tree's order; rows and columns are ranges of it. */
struct exchange_block {
    uint32_t row, rows, column, columns;
    size_t at; /* of its first value, row by row */
};

struct exchange_areas {
    const struct exchange_tree *tree; /* borrowed */
    uint32_t faces, inputs;
    uint32_t *input;        /* [faces]: by place in the tree's order, the scene file's face */
    double *area;           /* [inputs]: all parts, both sides (m2) */
    uint32_t *first, *next; /* places of input i: first[i], next[that] ...; UINT32_MAX ends */
    struct exchange_block *blocks; /* [block_count], of link_count links */
    size_t block_count, value_count, link_count;
    /* [value_count]: exchange areas A_i F_ij (m2), each pair of faces once per block that holds
     * it */
    double *values;
    /* [faces + 1]: the blocks that hold place p, as row or column: index[entry[p]] ... */
    size_t *entry;
    uint32_t *index; /* block * 2, + 1 where p is a column */
};

/* Take the links of a refinement of the tree, sort out one of each two ways round, and compute what
 * they stand for. Pairs nearer than `near` times the sum of their radii have the contour integral.
 * Returns 0, or -1 when out of memory; then there is nothing to free. */
int exchange_areas_open(struct exchange_areas *m, const struct exchange_tree *tree,
                        const struct scene *scene, const struct refinement *refinement, double near,
                        int threads);
/* The same, and tell from time to time, from the calling thread, which share is done; anything but
 * 0 ends it, which returns -1. */
struct exchange_watch {
    int (*tell)(void *context, double share); /* NULL: nobody is told */
    void *context;
};
int exchange_areas_open_watched(struct exchange_areas *m, const struct exchange_tree *tree,
                                const struct scene *scene, const struct refinement *refinement,
                                double near, int threads, const struct exchange_watch *watch);
void exchange_areas_close(struct exchange_areas *m);

/* Row i of A_i F_ij (m2), times scale[i] scale[j] when there is a scale: adds into row[inputs],
 * which is zero but for what is there. Returns its sum. */
double exchange_areas_row(const struct exchange_areas *m, uint32_t i, const double *scale,
                          double *row);

/* All rows' sums of A_i F_ij scale[j] (m2; scale may be NULL). */
void exchange_areas_sums(const struct exchange_areas *m, const double *scale, double *sums);

#endif
