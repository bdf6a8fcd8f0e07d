/* petsc_equation.h - the equation of light as PETSc takes it: (1 - K) x = source. The unknowns x
 * are the radiosities of the leaves that a rank has, all bands of them; K is as transport.c has it.
 * SPDX-License-Identifier: MIT */
#ifndef PETSC_EQUATION_H
#define PETSC_EQUATION_H

#ifdef RADIOSITY_PETSC
#include <petscksp.h>

#include "engine/transport.h"

struct petsc_equation {
    const struct light_operator *op;
    struct transport step;    /* without a source, on arrays of its own: what K makes of a vector */
    uint32_t *own, own_count; /* surfaces of this rank */
    uint32_t *leaf, leaves;   /* those of them that are not divided */
    /* means of all elements, and what they gather, as step's arrays */
    Vec everywhere, gathered;
    Vec sent;          /* of the own ones, for others: they alone; NULL: there is one rank */
    VecScatter ghosts; /* from there to everywhere */
    PetscInt *row, *column;
    double *weight; /* of the links between surfaces */
    Mat one, links; /* of one band; of all */
    Mat system;     /* 1 - K */
};

/* What this rank has of it, for as many bands as x; it stays where it is, as the system has its
 * address. Waits for nobody. All return 0 or an error of PETSc; either way petsc_equation_close. */
PetscErrorCode petsc_equation_open(struct petsc_equation *q, const struct light_operator *op,
                                   const struct transport *x);
/* What ranks make together. Waits for all. */
PetscErrorCode petsc_equation_join(struct petsc_equation *q, MPI_Comm comm);
/* Sets step.value of all elements that this rank knows to area means of its leaves' x, and of
 * others'. Waits for all. */
PetscErrorCode petsc_equation_spread(struct petsc_equation *q, const double *x);
void petsc_equation_close(struct petsc_equation *q);

#endif
#endif
