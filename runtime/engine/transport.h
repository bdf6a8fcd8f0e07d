/* transport.h - the one linear equation that is solved over the links, x = source + rho F V x.
 * SPDX-License-Identifier: MIT */
#ifndef TRANSPORT_H
#define TRANSPORT_H

#include "engine/operator.h"

struct change;

/* Radiosity (source: exitance) or whatever else travels as light does. */
struct transport {
    uint32_t bands;
    /* [element * bands + band]: start and result; clusters are left alone */
    double *value, *irradiance;
    /* [face * bands + band], or [element * bands + band] (leaves are read); NULL: there is none */
    const double *source;
    const double *reflectance; /* [face * bands + band] */
    int by_element;            /* which of the two the source is given by */
    /* what iteration may leave, relative; 0: a tenth of what constants on leaves leave
     * (variation.h), within SOLVE_TOLERANCE and SOLVE_TOLERANCE_MOST */
    double tolerance;
    /* 1: an estimate of what it leaves will do; 0: the bound must be within the tolerance, or as
     * low as precision lets it be (transport.c) */
    int rough;
    /* after each sweep; NULL: none; nonzero stops */
    int (*watch)(void *context, const struct transport *x);
    void *watch_context;

    /* of this solve; what Southwell's method shoots between sweeps counts by the links it takes */
    int sweeps, converged;
    double moved;    /* by the last sweep (W): sum A |dx| over leaves */
    double residual; /* the same over sum A x */
    /* on what iteration has left: sum A |x - its limit| / sum A x; INFINITY where rows are too
     * large for one */
    double bound;
    double held;      /* the tolerance that the bound was last held against */
    double variation; /* where that was asked for, what constants leave; else 0 */
    char cause[200];  /* of a failure, in a sentence; "": out of memory, or the watch said so */
};

/* Iterate until what that leaves is within the tolerance, by the solver that the problem's options
 * name; the row scales are set (row_sums.h). Returns 0, or -1 when out of memory, stopped by
 * `watch` or with x->cause set. */
int transport_solve(const struct light_operator *op, struct transport *x);

/* One sweep over all faces, in blocks; by Jacobi's method in one, which takes all of `value` as it
 * was. change: [face], room for what it changes (push_pull.h); room: [shares_room * bands]. What
 * other ranks have is right where links of this one take light from, if it was before. */
void transport_sweep(const struct light_operator *op, const struct transport *x, int jacobi,
                     struct change *change, double *room);

/* How long a bound has not fallen. */
struct stall {
    double least; /* bound of all sweeps */
    int sweeps;   /* since then, that one counted; 0: none yet */
};

/* After each sweep: does the bound fall no more, for last digits (transport.c)? */
int transport_stalled(const struct light_operator *op, const struct transport *x,
                      struct stall *stall);

/* Means of the clusters in value and irradiance, whose surfaces have theirs. */
void transport_average(const struct light_operator *op, struct transport *x);

#endif
