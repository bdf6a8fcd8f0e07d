/* closure.h - rows that sum to what they should.
 *
 * A row is what a surface gathers of all others, sum of F V, which is 1 when the surface sees
 * nothing but surfaces, and less where light comes in from outside the scene or from black backs.
 * SPDX-License-Identifier: MIT */
#ifndef CLOSURE_H
#define CLOSURE_H

enum closure {
    CLOSURE_NONE,       /* rows are left as they are, but for what a method needs to stay stable */
    CLOSURE_ROWS,       /* each row is scaled to 1 if it ought to sum to 1, else to at most 1 */
    CLOSURE_RECIPROCAL, /* the same, with A_i F_ij = A_j F_ji kept: of exchange areas only */
};

/* The factor of a row that sums to `sum` where all would be `whole`. `closed`: it ought to be. */
double closure_row_scale(double sum, double whole, int closed);

/* What closure does to a matrix of exchange areas. */
struct exchange_areas;
struct exchange_closure {
    /* [inputs]: F_ij is multiplied by scale[i] (rows), by scale[i] scale[j] (reciprocal); NULL:
     * by 1 */
    double *scale;
    int both; /* 1: by both */
    int iterations;
    /* reciprocal: the largest |1 - sum| that is left of rows that ought to sum to 1 */
    double left;
    double change; /* the largest |factor - 1| that a view factor took */
};

/* sums: row sums of A_i F_ij (m2). closed: by row, 1: it ought to sum to A_i; others are only kept
 * from summing to more. Returns 0, or -1 when out of memory. */
int exchange_closure_make(struct exchange_closure *c, enum closure kind,
                          const struct exchange_areas *m, int threads, const double *sums,
                          const unsigned char *closed);
void exchange_closure_free(struct exchange_closure *c);

#endif
