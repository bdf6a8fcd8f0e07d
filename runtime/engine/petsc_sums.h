/* petsc_sums.h - dot products of PETSc's vectors, the same to the bit on any number of ranks.
 * SPDX-License-Identifier: MIT */
#ifndef PETSC_SUMS_H
#define PETSC_SUMS_H

#ifdef RADIOSITY_PETSC
#include <petscvec.h>

/* Let the vector, of type VECMPI, and all that are made after it, add so. */
void petsc_sums_exactly(Vec v);

#endif
#endif
