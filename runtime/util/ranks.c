/* ranks.c - see ranks.h; by MPI, or by nothing.
 * SPDX-License-Identifier: MIT */
#include "util/ranks.h"

#include <stdlib.h>
#include <string.h>

#ifdef RADIOSITY_MPI

#include <mpi.h>

struct ranks {
    MPI_Comm all;
    int count, number;
    uint64_t sent[RANKS_KINDS];
    int *counts, *places; /* [2 * count]: to each and from each */
};

struct ranks *ranks_open(const void *communicator, const char **cause)
{
    int begun = 0, ended = 0;
    MPI_Initialized(&begun);
    MPI_Finalized(&ended);
    *cause = "MPI has not been started: MPI_Init comes first";
    if (!begun || ended)
        return NULL;
    struct ranks *r = calloc(1, sizeof *r);
    *cause = "out of memory";
    if (!r)
        return NULL;
    MPI_Comm_dup(*(const MPI_Comm *)communicator, &r->all);
    MPI_Comm_size(r->all, &r->count);
    MPI_Comm_rank(r->all, &r->number);
    r->counts = calloc(2 * (size_t)r->count, sizeof *r->counts);
    r->places = calloc(2 * (size_t)r->count, sizeof *r->places);
    if (r->counts && r->places)
        return r;
    ranks_close(r);
    return NULL;
}

/* The communicator stays, until MPI ends: to free it waits for all, and a rank that has failed
 * would wait for others that have not. */
void ranks_close(struct ranks *r)
{
    if (!r)
        return;
    free(r->counts);
    free(r->places);
    free(r);
}

int ranks_count(const struct ranks *r)
{
    return r ? r->count : 1;
}

int ranks_number(const struct ranks *r)
{
    return r ? r->number : 0;
}

uint64_t ranks_sent(const struct ranks *r, enum ranks_kind kind)
{
    return r ? r->sent[kind] : 0;
}

enum { PIECE = 1 << 28 }; /* items that one call of MPI's is given, which counts by int */

static void reduce(struct ranks *r, enum ranks_kind kind, void *value, size_t count,
                   MPI_Datatype type, MPI_Op op)
{
    if (ranks_count(r) == 1)
        return;
    for (size_t from = 0; from < count; from += PIECE) {
        const size_t n = count - from < PIECE ? count - from : PIECE;
        MPI_Allreduce(MPI_IN_PLACE, (char *)value + 8 * from, (int)n, type, op, r->all);
    }
    r->sent[kind] += 2 * 8 * count * (uint64_t)(r->count - 1) / (uint64_t)r->count;
}

void ranks_add_counts(struct ranks *r, enum ranks_kind kind, uint64_t *value, size_t count)
{
    reduce(r, kind, value, count, MPI_UINT64_T, MPI_SUM);
}

void ranks_add(struct ranks *r, enum ranks_kind kind, double *value, size_t count)
{
    reduce(r, kind, value, count, MPI_DOUBLE, MPI_SUM);
}

void ranks_most(struct ranks *r, enum ranks_kind kind, double *value, size_t count)
{
    reduce(r, kind, value, count, MPI_DOUBLE, MPI_MAX);
}

int ranks_any(struct ranks *r, int so)
{
    int any = so != 0;
    if (ranks_count(r) > 1)
        MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPI_INT, MPI_MAX, r->all);
    return any;
}

/* An item as MPI counts it. */
static MPI_Datatype type_of(size_t size)
{
    MPI_Datatype type;
    MPI_Type_contiguous((int)size, MPI_BYTE, &type);
    MPI_Type_commit(&type);
    return type;
}

void ranks_complete(struct ranks *r, enum ranks_kind kind, void *array, size_t size,
                    const size_t *first)
{
    if (ranks_count(r) == 1 || first[r->count] == first[0])
        return;
    MPI_Datatype type = type_of(size);
    for (int k = 0; k < r->count; k++) {
        r->counts[k] = (int)(first[k + 1] - first[k]);
        r->places[k] = (int)first[k];
    }
    MPI_Allgatherv(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, array, r->counts, r->places, type, r->all);
    MPI_Type_free(&type);
    r->sent[kind] += (first[r->number + 1] - first[r->number]) * size * (uint64_t)(r->count - 1);
}

void ranks_complete_parts(struct ranks *r, enum ranks_kind kind, void *array, size_t size,
                          size_t count)
{
    if (ranks_count(r) == 1)
        return;
    size_t *first = malloc(((size_t)r->count + 1) * sizeof *first);
    if (!first)
        MPI_Abort(r->all, 1);
    for (int k = 0; k <= r->count; k++)
        first[k] = ranks_part(r, count, k);
    ranks_complete(r, kind, array, size, first);
    free(first);
}

void ranks_exchange_known(struct ranks *r, enum ranks_kind kind, const void *items, size_t size,
                          const size_t *count, void *to, const size_t *from)
{
    const int n = ranks_count(r);
    if (n == 1) {
        if (count[0])
            memcpy(to, items, count[0] * size);
        return;
    }
    MPI_Datatype type = type_of(size);
    size_t sent = 0, came = 0;
    for (int k = 0; k < n; k++) {
        r->counts[k] = (int)count[k];
        r->places[k] = (int)sent;
        r->counts[n + k] = (int)from[k];
        r->places[n + k] = (int)came;
        sent += count[k];
        came += from[k];
        r->sent[kind] += k == r->number ? 0 : count[k] * size;
    }
    MPI_Alltoallv(items, r->counts, r->places, type, to, r->counts + n, r->places + n, type,
                  r->all);
    MPI_Type_free(&type);
}

void *ranks_exchange(struct ranks *r, enum ranks_kind kind, const void *items, size_t size,
                     const size_t *count, size_t *from)
{
    size_t all = 0;
    from[0] = count[0];
    if (ranks_count(r) > 1)
        MPI_Alltoall(count, sizeof *count, MPI_BYTE, from, sizeof *from, MPI_BYTE, r->all);
    for (int k = 0; k < ranks_count(r); k++)
        all += from[k];
    void *to = malloc(all * size + 1);
    if (ranks_any(r, !to)) {
        free(to);
        return NULL;
    }
    ranks_exchange_known(r, kind, items, size, count, to, from);
    return to;
}

void ranks_tell(struct ranks *r, enum ranks_kind kind, void *item, size_t size)
{
    if (ranks_count(r) == 1)
        return;
    for (size_t from = 0; from < size; from += PIECE)
        MPI_Bcast((char *)item + from, (int)(size - from < PIECE ? size - from : PIECE), MPI_BYTE,
                  0, r->all);
    r->sent[kind] += r->number == 0 ? size * (uint64_t)(r->count - 1) : 0;
}

#else

struct ranks *ranks_open(const void *communicator, const char **cause)
{
    (void)communicator;
    *cause = "this library was built without MPI: make MPI=1";
    return NULL;
}

void ranks_close(struct ranks *r)
{
    (void)r;
}

int ranks_count(const struct ranks *r)
{
    (void)r;
    return 1;
}

int ranks_number(const struct ranks *r)
{
    (void)r;
    return 0;
}

uint64_t ranks_sent(const struct ranks *r, enum ranks_kind kind)
{
    (void)r;
    (void)kind;
    return 0;
}

void ranks_add_counts(struct ranks *r, enum ranks_kind kind, uint64_t *value, size_t count)
{
    (void)r;
    (void)kind;
    (void)value;
    (void)count;
}

void ranks_add(struct ranks *r, enum ranks_kind kind, double *value, size_t count)
{
    (void)r;
    (void)kind;
    (void)value;
    (void)count;
}

void ranks_most(struct ranks *r, enum ranks_kind kind, double *value, size_t count)
{
    (void)r;
    (void)kind;
    (void)value;
    (void)count;
}

int ranks_any(struct ranks *r, int so)
{
    (void)r;
    return so != 0;
}

void ranks_complete(struct ranks *r, enum ranks_kind kind, void *array, size_t size,
                    const size_t *first)
{
    (void)r;
    (void)kind;
    (void)array;
    (void)size;
    (void)first;
}

void ranks_complete_parts(struct ranks *r, enum ranks_kind kind, void *array, size_t size,
                          size_t count)
{
    (void)r;
    (void)kind;
    (void)array;
    (void)size;
    (void)count;
}

void ranks_exchange_known(struct ranks *r, enum ranks_kind kind, const void *items, size_t size,
                          const size_t *count, void *to, const size_t *from)
{
    (void)r;
    (void)kind;
    (void)from;
    if (count[0])
        memcpy(to, items, count[0] * size);
}

void *ranks_exchange(struct ranks *r, enum ranks_kind kind, const void *items, size_t size,
                     const size_t *count, size_t *from)
{
    void *to = malloc(count[0] * size + 1);
    if (to)
        ranks_exchange_known(r, kind, items, size, count, to, count);
    from[0] = count[0];
    return to;
}

void ranks_tell(struct ranks *r, enum ranks_kind kind, void *item, size_t size)
{
    (void)r;
    (void)kind;
    (void)item;
    (void)size;
}

#endif
