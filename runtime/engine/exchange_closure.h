/* factor_closure.h - make rows of view factors sum to what they should.
 * SPDX-License-Identifier: MIT */
#ifndef FACTOR_CLOSURE_H
#define FACTOR_CLOSURE_H

#include "engine/environment.h"

enum factor_closure_kind { FACTOR_CLOSURE_NONE, FACTOR_CLOSURE_ROWS, FACTOR_CLOSURE_RECIPROCAL, FACTOR_CLOSURES };
extern const char *const factor_closure_names[FACTOR_CLOSURES]; /* none, rows, reciprocal */

struct factor_closure {
    double *scale;    /* [inputs]: F_ij is multiplied by scale[i] (rows), by scale[i] scale[j] (reciprocal); NULL: by 1 */
    int both;         /* 1: by both */
    int iterations;
    double left;      /* the largest |1 - sum| that is left of rows that ought to sum to 1 */
    double most;      /* the largest |factor - 1| that a view factor took */
};

/* sums: row sums of A_i F_ij (m2); sky: of every row, asked. Rows that see sky, or are buried in part, are only kept from
 * summing to more than 1. Returns 0, or -1 when out of memory. */
int factor_closure_make(struct factor_closure *c, enum factor_closure_kind kind, const struct factor_matrix *m, const double *sums,
                        const struct factor_sky *sky);
void factor_closure_free(struct factor_closure *c);

#endif
