/* importance.h - what a view makes of the light that leaves each place.
 * SPDX-License-Identifier: MIT */
#ifndef IMPORTANCE_H
#define IMPORTANCE_H

#include "engine/oracle_inputs.h"
#include "engine/transport.h"

/* Arrays are [capacity], element by element. */
struct importance {
    double *response;                      /* r, the share that is in the picture */
    double *source, *carried, *irradiance; /* rho r, Z = rho Y, and what Z irradiates */
    double *value;                         /* Y */
    size_t capacity;
    uint32_t started;
    int sweeps;           /* 0: no importance was asked for */
    double largest, mean; /* of Y over the leaves, the mean by area */
    double seen;          /* area in the picture (m2) */
};

/* Before the first refinement: what the view sees of every face is all that counts, and every face
 * does where there is no view. Returns 0, or -1 on all ranks when any is out of memory. */
int importance_start(struct importance *y, const struct light_operator *op, struct hierarchy *h,
                     struct oracle_inputs *in);

/* Set *carried to importance's equation over the links as they are. Returns 0, or -1 on all
 * ranks when any is out of memory. */
int importance_open(struct importance *y, const struct light_operator *op,
                    struct transport *carried);

/* From the solved equation, let the oracles see importance; changed[e] becomes 1 where it grew. */
void importance_update(struct importance *y, const struct light_operator *op, struct hierarchy *h,
                       struct oracle_inputs *in);

void importance_free(struct importance *y);

#endif
