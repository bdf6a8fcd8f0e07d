/* error_control.h - link thresholds that follow the error of the radiosities they lead to.
 * SPDX-License-Identifier: MIT */
#ifndef ERROR_CONTROL_H
#define ERROR_CONTROL_H

#include "engine/oracle_inputs.h"
#include "engine/residual.h"

struct error_control {
    double target;                  /* the error of radiosity to be held (W/m2); 0: nobody asked */
    struct leaf_residual *residual; /* [capacity]: of the leaves, element by element */
    size_t capacity;
    double largest; /* of the estimates (W/m2) */
    double area;    /* of the leaves whose estimate is above the target (m2) */
};

/* The error of radiosity to be held (W/m2), by the oracle's own parameters: the larger of `epsilon`
 * and `relative` times the scene's mean radiosity. 0 when the oracle reads no error tolerance, or
 * has no such parameter. */
double error_control_target(const struct refiner *refiner, const struct host *host);

/* What the oracle promises for the powers of all faces together, in each band (W), by the
 * parameters of that role; 0: nothing. Links alone do not keep it: it has to be measured. */
double power_tolerance(const struct refiner *refiner, const struct host *host);

/* Before the first refinement: the error tolerance of each face's links. */
void error_control_start(struct error_control *c, double target, struct hierarchy *h,
                         struct oracle_inputs *in);

/* Estimate every leaf's error anew, with B = radiosity[element * bands + band]. Returns 0, or -1
 * when out of memory. */
int error_control_estimate(struct error_control *c, const struct light_operator *op,
                           const double *radiosity);

/* Lower the error tolerance of leaves whose estimate is above the target, and of what they are part
 * of; changed[e] becomes 1 where it fell. Returns how many leaves it was lowered of; 0: nothing is
 * above, or nothing is left that helps. */
uint32_t error_control_tighten(const struct error_control *c, const struct light_operator *op,
                               struct hierarchy *h, struct oracle_inputs *in);

void error_control_free(struct error_control *c);

#endif
