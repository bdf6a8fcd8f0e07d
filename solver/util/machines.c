/* machines.c - see machines.h.
 * SPDX-License-Identifier: MIT */
#include "util/machines.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What the launchers of MPI programs tell each process that there are. */
static const char *const sizes[] = {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "MPI_LOCALNRANKS"};

static int launched(void)
{
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        const char *size = getenv(sizes[i]);
        if (size && *size)
            return atoi(size);
    }
    return 0;
}

#ifdef RADIOSITY_MPI

#include <mpi.h>
#include <signal.h>
#include <time.h>

enum { KEPT = 1 << 14, PATIENCE = 10 };

static int begun, ranks = 1, rank, left_open, told; /* told: of an error, or kept one */
static char kept[KEPT];

int machines_begin(int *count, char ***arguments)
{
    int given;
    if (launched() < 1)
        return 0;
    MPI_Init_thread(count, arguments, MPI_THREAD_FUNNELED, &given);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    begun = 1;
    if (rank > 0 && !freopen("/dev/null", "w", stdout))
        return 2;
    return 0;
}

int machines_count(void)
{
    return ranks;
}

int machines_number(void)
{
    return rank;
}

RadDevice machines_device(const struct RadDeviceOptions *options)
{
    const MPI_Comm all = MPI_COMM_WORLD;
    return ranks > 1 ? radNewDeviceMPI(options, &all) : radNewDevice(options);
}

int machines_agree(int status)
{
    if (ranks > 1)
        MPI_Allreduce(MPI_IN_PLACE, &status, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
    return status;
}

void machines_place(uint64_t count, uint64_t *first, uint64_t *all)
{
    *first = 0;
    *all = count;
    if (ranks == 1)
        return;
    MPI_Exscan(&count, first, 1, MPI_UINT64_T, MPI_SUM, MPI_COMM_WORLD);
    if (rank == 0)
        *first = 0;
    MPI_Allreduce(MPI_IN_PLACE, all, 1, MPI_UINT64_T, MPI_SUM, MPI_COMM_WORLD);
}

int machines_alike(uint64_t number)
{
    uint64_t most[2] = {number, ~number};
    if (ranks > 1)
        MPI_Allreduce(MPI_IN_PLACE, most, 2, MPI_UINT64_T, MPI_MAX, MPI_COMM_WORLD);
    return most[0] == ~most[1];
}

int machines_keep(const char *line, int error)
{
    const size_t used = strlen(kept);
    told |= error;
    if (rank > 0)
        snprintf(kept + used, KEPT - used, "%s", line);
    return rank > 0;
}

/* Have all come to the end? A rank that has failed waits for others so long. */
static int all_ended(int status, int *worst)
{
    int there = 0;
    MPI_Request request;
    const time_t start = time(NULL);
    MPI_Iallreduce(&status, worst, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD, &request);
    while (!there && (status == 0 || time(NULL) - start < PATIENCE)) {
        const struct timespec pause = {0, 2000000};
        MPI_Test(&request, &there, MPI_STATUS_IGNORE);
        if (!there)
            nanosleep(&pause, NULL);
    }
    return there;
}

void machines_leave_open(void)
{
    left_open = 1;
}

int machines_end(int status)
{
    int worst = status;
    if (!begun)
        return status;
    if (!all_ended(status, &worst)) {
        fprintf(stderr, "%srank %d of %d could not go on: the run ends\n", kept, rank, ranks);
        fflush(stderr);
        MPI_Abort(MPI_COMM_WORLD, status);
    }
    /* The first that can tell why is heard: others may have ended only because of it. Where rank 0
     * ends without an error, as one that was stopped does, and nobody has any, all is said. */
    const int knows = status != 0 && told, fails = status != 0;
    int first[2] = {knows ? rank : ranks, fails ? rank : ranks};
    MPI_Allreduce(MPI_IN_PLACE, first, 2, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
    if (rank > 0 && rank == (first[0] < ranks ? first[0] : first[1]))
        fprintf(stderr, "%srank %d of %d could not go on\n", kept, rank, ranks);
    /* what one wrote alone, too */
    MPI_Allreduce(MPI_IN_PLACE, &left_open, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
    if (left_open) {
        fflush(stderr);
        signal(SIGTERM, SIG_DFL); /* by which the others are ended, and have nothing to say */
        MPI_Barrier(MPI_COMM_WORLD);
        MPI_Abort(MPI_COMM_WORLD, worst ? worst : 1);
    }
    MPI_Finalize();
    return worst;
}

#else

int machines_begin(int *count, char ***arguments)
{
    (void)count;
    (void)arguments;
    if (launched() < 2)
        return 0;
    fprintf(stderr,
            "radiosity: error: started as one of %d processes, but built without MPI: "
            "build it by `make MPI=1`\n",
            launched());
    return 2;
}

int machines_count(void)
{
    return 1;
}

int machines_number(void)
{
    return 0;
}

RadDevice machines_device(const struct RadDeviceOptions *options)
{
    return radNewDevice(options);
}

int machines_agree(int status)
{
    return status;
}

void machines_place(uint64_t count, uint64_t *first, uint64_t *all)
{
    *first = 0;
    *all = count;
}

int machines_alike(uint64_t number)
{
    (void)number;
    return 1;
}

int machines_keep(const char *line, int error)
{
    (void)line, (void)error;
    return 0;
}

void machines_leave_open(void)
{
}

int machines_end(int status)
{
    return status;
}

#endif
