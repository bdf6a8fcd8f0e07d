/* petsc_start.c - see petsc_start.h.
 *
 * A program may have begun PETSc or MPI itself, or both, or neither; whoever begins ends. What we
 * have begun ends as MPI does, by the destructor of an attribute that MPI calls first of all, and
 * where we have begun MPI, too, when the process exits. Until then PETSc stays: once ended it
 * cannot be had again.
 *
 * PETSc begins together, on the communicator that it is given; a process that has it already does
 * not take part. So it begins over the ranks where none has it yet, else each by itself. What
 * PETSC_OPTIONS says then is rank 0's word, for all.
 * [PETSc's manual, "Running PETSc programs" and "Error handling"; MPI 3.1, section 8.7.1]
 * SPDX-License-Identifier: MIT */
#ifdef RADIOSITY_PETSC
#include "engine/petsc_start.h"

#include <petscsys.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SENTENCE = 160 };

static pthread_mutex_t alone = PTHREAD_MUTEX_INITIALIZER;
static char said[SENTENCE]; /* the first complaint since petsc_begin */
static int pushed;          /* `hear` is there */
static int ours;            /* from petsc_begin to petsc_end; else errors are the program's */

/* Keep the first line of what is wrong where it is found; callers add nothing to it. */
static PetscErrorCode hear(MPI_Comm comm, int line, const char *function, const char *file,
                           PetscErrorCode error, PetscErrorType type, const char *message,
                           void *context)
{
    if (!ours)
        return PetscTraceBackErrorHandler(comm, line, function, file, error, type, message,
                                          context);
    if (!said[0] && message && message[0] > ' ')
        snprintf(said, sizeof said, "%.*s", (int)strcspn(message, "\n"), message);
    return error;
}

static int is_begun(void)
{
    PetscBool begun = PETSC_FALSE;
    PetscInitialized(&begun);
    return begun != PETSC_FALSE;
}

/* Unless the program has done so. */
static void end(void)
{
    if (is_begun())
        PetscFinalize();
}

static int end_with_mpi(MPI_Comm comm, int key, void *value, void *context)
{
    (void)comm, (void)key, (void)value, (void)context;
    end();
    return MPI_SUCCESS;
}

static PetscErrorCode begin(MPI_Comm comm)
{
    int mpi = 0, key;
    MPI_Initialized(&mpi);
    if (mpi)
        PETSC_COMM_WORLD = comm;
    /* This one stays: what was made before PETSc has begun it does not always free well. */
    PetscCall(PetscPushErrorHandler(hear, NULL));
    /* Signals are whoever's the program is. */
    PetscCall(PetscOptionsSetValue(NULL, "-no_signal_handler", "1"));
    PetscCall(PetscInitialize(NULL, NULL, NULL, NULL));
    if (!mpi)
        return atexit(end) ? PETSC_ERR_LIB : 0;
    PetscCallMPI(MPI_Comm_create_keyval(MPI_COMM_NULL_COPY_FN, end_with_mpi, &key, NULL));
    PetscCallMPI(MPI_Comm_set_attr(MPI_COMM_SELF, key, NULL));
    PetscCallMPI(MPI_Comm_free_keyval(&key));
    return 0;
}

/* Rank 0's options, where ranks have begun by themselves. */
static PetscErrorCode share_options(struct ranks *ranks)
{
    const char *mine = getenv("PETSC_OPTIONS");
    size_t length = mine ? strlen(mine) : 0;
    ranks_tell(ranks, RANKS_VALUES, &length, sizeof length);
    char *all = calloc(1, length + 1);
    if (ranks_any(ranks, !all)) {
        free(all);
        return PETSC_ERR_MEM;
    }
    if (ranks_number(ranks) == 0 && mine)
        memcpy(all, mine, length);
    ranks_tell(ranks, RANKS_VALUES, all, length);
    const PetscErrorCode error = PetscOptionsInsertString(NULL, all);
    free(all);
    return error;
}

int petsc_begin(struct ranks *ranks, MPI_Comm *comm)
{
    pthread_mutex_lock(&alone);
    const int begun = is_begun(), any = ranks_any(ranks, begun);
    const void *all = ranks_communicator(ranks);
    *comm = all ? *(const MPI_Comm *)all : MPI_COMM_SELF;
    said[0] = 0;
    ours = 1;
    PetscErrorCode error = begun ? 0 : begin(any ? MPI_COMM_SELF : *comm);
    pushed = !error && PetscPushErrorHandler(hear, NULL) == 0;
    if (!ranks_any(ranks, error != 0) && any && ranks_any(ranks, !begun))
        error = share_options(ranks);
    return (int)error;
}

int petsc_end(struct ranks *ranks, int error, char *cause, size_t size)
{
    const int failed = ranks_any(ranks, error != 0), out = ranks_any(ranks, error == PETSC_ERR_MEM);
    if (pushed)
        PetscPopErrorHandler();
    ours = 0;
    if (failed && !out) {
        const char *options = getenv("PETSC_OPTIONS");
        snprintf(cause, size, "PETSc cannot solve: %s%s%s", said[0] ? said : "it does not say why",
                 options && *options ? "; PETSC_OPTIONS is " : "", options ? options : "");
    }
    pthread_mutex_unlock(&alone);
    return failed ? -1 : 0;
}
#else
typedef int petsc_start_nothing; /* a file has something in it */
#endif
