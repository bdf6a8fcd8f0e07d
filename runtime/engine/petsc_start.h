/* petsc_start.h - PETSc, begun where nobody has, and what it complains of as a sentence.
 *
 * PETSc is one for a process and knows nothing of threads: whoever works with it has it alone.
 * SPDX-License-Identifier: MIT */
#ifndef PETSC_START_H
#define PETSC_START_H

#ifdef RADIOSITY_PETSC
#include <mpi.h>
#include <stddef.h>
#include "util/ranks.h"

/* Take PETSc, over the ranks of a run; errors return. Sets *comm to what these have in common.
 * Returns 0, or what petsc_end is told; that comes next in either case. */
int petsc_begin(struct ranks *ranks, MPI_Comm *comm);

/* Let it go. error: what a call of PETSc's has returned; where any rank's is not 0, the first
 * complaint goes into cause[size]. Returns 0, or -1 on all ranks. */
int petsc_end(struct ranks *ranks, int error, char *cause, size_t size);

#endif
#endif
