/* petsc_solution.h - the equation solved by PETSc, with whatever Krylov method its options name.
 * SPDX-License-Identifier: MIT */
#ifndef PETSC_SOLUTION_H
#define PETSC_SOLUTION_H

#include "engine/transport.h"

/* 1: this library was built with PETSc (make PETSC=1); 0: there is no petsc_solution_make. */
int petsc_solution_built(void);

/* Set x->value to the solution, as far as x->tolerance asks for it, from what stands there; x's
 * sweeps count what the method takes. Its irradiance is left to the sweep that follows. Waits for
 * all ranks, and is the same to the bit on any number of them. Returns 0, or -1 when out of memory,
 * stopped by `watch`, or with x->cause set, on all. */
int petsc_solution_make(const struct light_operator *op, struct transport *x);

#endif
