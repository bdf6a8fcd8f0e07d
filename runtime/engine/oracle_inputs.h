/* oracle_inputs.h - what the oracles see of a solution: radiosity and spread of every element.
 * SPDX-License-Identifier: MIT */
#ifndef ORACLE_INPUTS_H
#define ORACLE_INPUTS_H

#include "engine/operator.h"

struct oracle_inputs {
    /* [element]: what the oracles see of it has grown since the links were discussed */
    unsigned char *changed;
    double known; /* relative: what iteration may have left of the radiosities they see */
};

/* Radiosity and spread of every element, from B [element * bands + band]. changed[e] becomes 1
 * where an oracle sees one of them grow, else 0. Returns 0, or -1 on all ranks when any is out of
 * memory. */
int oracle_inputs_update(struct oracle_inputs *in, const struct light_operator *op,
                         const double *radiosity, struct hierarchy *h);

/* What the oracles see of a value that is `now`: it follows when they differ by more than the share
 * `within`. Returns 1 when it grew by more than that and `unknown`. */
static inline int oracle_inputs_follow(double *seen, double now, double within, double unknown)
{
    int grew = now > (1 + within) * *seen + unknown;
    if (grew || now < (1 - within) * *seen)
        *seen = now;
    return grew;
}

/* Before the first solve the oracles see what the light is likely to be: E + rho H with the
 * scene's mean irradiance. Groups get the reflectance of their whitest face: an error over a group
 * is no smaller where most of it is black. */
void oracle_inputs_guess(const struct problem *p, struct hierarchy *h);

#endif
