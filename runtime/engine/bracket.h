/* bracket.h - a lower and an upper solution over the links, between which the true one is.
 * SPDX-License-Identifier: MIT */
#ifndef BRACKET_H
#define BRACKET_H

#include "engine/oracle_inputs.h"

/* Arrays are [capacity], element * bands + band; NULL: nobody asked. */
struct bracket {
    /* B (W/m2): no uncovered point of the element has less, or more */
    double *lower, *upper, *next;
    size_t capacity;
    uint32_t started;
    unsigned char *closed; /* [element]: no light leaves the scene from there (winding.h) */
    float (*range)[2];     /* [link]: F V of any point of the receiver is between */
    int solves;
    double power[2]; /* W, all bands: sum over uncovered leaves of A times lower, and upper */
};

/* Before the first refinement: what is true of any scene with this light. Returns 0, or -1 when out
 * of memory. */
int bracket_start(struct bracket *b, const struct light_operator *op, struct hierarchy *h);

/* Solve over the links as they are and show the oracles lower and gap of each element; changed[e]
 * becomes 1 where one of them grew. The bounds hold as long as the oracle drops no pair that
 * exchanges light. Returns 0, or -1 when out of memory. */
int bracket_update(struct bracket *b, const struct light_operator *op, struct hierarchy *h,
                   struct oracle_inputs *in);

void bracket_free(struct bracket *b);

#endif
