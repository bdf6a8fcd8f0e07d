/* exchange_areas.h - the matrix of exchange areas, in blocks. What A_i F_ij is, once for both ways.
 *
 * Blocks that need a look at what stands between are kept. Those of groups in clear view, which are
 * most of a large matrix and by far the cheapest, are kept up to a limit; beyond it they are made
 * anew, line by line, for each who asks, to the same bits.
 * SPDX-License-Identifier: MIT */
#ifndef EXCHANGE_AREAS_H
#define EXCHANGE_AREAS_H

#include "engine/exchange_blocks.h"
#include "engine/exchange_tree.h"
#include "engine/refine.h"
#include "hierarchy/scene.h"
#include "util/ranks.h"

struct exchange_state;

/* Faces stand in the tree's order; rows and columns are ranges of it. */
struct exchange_block {
    uint32_t row, column;
    uint16_t rows, columns;
    uint32_t anew; /* 0: values are kept; else it is made anew from links[anew - 1] */
    size_t at;     /* of its first value, row by row; made anew: of the next that is kept */
    double error;  /* the largest that is estimated of its values, of the smaller area of each */
};

struct exchange_aim {
    double tolerance; /* of entries (engine/exchange_clear.h, engine/exchange_sight.h) */
    uint32_t rows;    /* only the first so many are whole: 0, all */
    /* 1: none is kept, and only products can be asked for */
    int stream;
    size_t keep; /* how many values of groups in clear view are kept at the most */
    int threads;
    /* Told now and then, from the calling thread, which share of the kept values is there; anything
     * but 0 ends it, which returns -1. NULL: nobody is. */
    int (*tell)(void *context, double share);
    void *context;
    /* What was done before this run is read from it, and it is asked wherever `tell` is, and at the
     * end (engine/exchange_state.h). NULL: there is none. */
    struct exchange_state *state;
    struct ranks *ranks; /* who works on it together; borrowed, NULL: one process */
};

struct exchange_areas {
    const struct exchange_tree *tree;    /* borrowed */
    uint32_t faces, inputs, rows;        /* rows: of the first so many inputs */
    struct sight_limits limits;          /* by its tolerance */
    const struct refinement *refinement; /* of a stream, borrowed; else NULL */
    struct ranks *ranks;                 /* borrowed; NULL: one process */
    struct exchange_faces shapes;
    uint32_t *input;        /* [faces]: by place in the tree's order, the scene file's face */
    double *area;           /* [inputs]: all parts, both sides (m2) */
    uint32_t *first, *next; /* places of input i: first[i], next[that] ...; UINT32_MAX ends */
    size_t value_count, link_count; /* of so many links so many values */
    size_t own_count;               /* of the kept ones, that this rank has filled */
    /* The rest is there unless it is a stream. */
    struct exchange_block *blocks; /* [block_count] */
    size_t block_count, kept;
    /* [kept]: exchange areas A_i F_ij (m2), each pair of faces once per block that holds it */
    double *values;
    struct link *links; /* [links_anew]: of blocks that are made anew */
    uint32_t links_anew;
    /* [faces + 1]: the blocks that hold place p, as row or column: index[entry[p]] ... */
    size_t *entry;
    uint32_t *index; /* block * 2, + 1 where p is a column */
};

/* Take the links of a refinement of the tree, sort out one of each two ways round, and compute what
 * they stand for. Of a stream it must outlive the areas, and there are no rows. Returns 0, or -1
 * when out of memory, or not wanted any more, or not started by the state; then there is nothing to
 * free. */
int exchange_areas_open(struct exchange_areas *m, const struct exchange_tree *tree,
                        const struct scene *scene, const struct refinement *refinement,
                        const struct exchange_aim *how);
void exchange_areas_close(struct exchange_areas *m);

/* What one tile of a link stands for: values[rows][columns] (exchange_blocks.h). Returns
 * the largest error estimated, of the smaller area of each pair. */
double exchange_tile_fill(const struct exchange_areas *m, const struct exchange_block *b,
                          const struct link *link, struct exchange_scratch *scratch,
                          double *values);

/* Row i of A_i F_ij (m2), times scale[i] scale[j] when there is a scale: adds into row[inputs],
 * which is zero but for what is there. Returns its sum. */
double exchange_areas_row(const struct exchange_areas *m, uint32_t i, const double *scale,
                          double *row);

/* The largest error of any F_ij that is estimated, 0 of a stream. -1 when out of memory. */
double exchange_areas_error(const struct exchange_areas *m);

#endif
