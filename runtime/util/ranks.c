/* ranks.c - see ranks.h. What is asked of MPI stands first; without it there is one rank, and
 * nobody asks.
 * SPDX-License-Identifier: MIT */
#include "util/ranks.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#ifdef RADIOSITY_MPI
#include <mpi.h>
#else
typedef int MPI_Comm;
#endif

struct ranks {
    MPI_Comm all;
    int count, number, beside;
    uint64_t sent[RANKS_KINDS];
    int *counts, *places; /* [2 * count]: to each and from each */
};

enum reduction { SUM_OF_COUNTS, SUM, MOST, ANY };

#ifdef RADIOSITY_MPI

enum { PIECE = 1 << 28 }; /* items that one call of MPI's is given, which counts by int */
enum { ASKED_WITHOUT_PAUSE = 200, PAUSE = 20000, LONGEST = 2000000 }; /* ns; Linux adds 50,000 */

/* Of MPI that has begun. Returns NULL, or why not. */
static const char *join(struct ranks *r, const void *communicator)
{
    int begun = 0, ended = 0;
    MPI_Initialized(&begun);
    MPI_Finalized(&ended);
    if (!begun || ended)
        return "MPI has not been started: MPI_Init comes first";
    MPI_Comm_dup(*(const MPI_Comm *)communicator, &r->all);
    MPI_Comm_size(r->all, &r->count);
    MPI_Comm_rank(r->all, &r->number);
    MPI_Comm here;
    MPI_Comm_split_type(r->all, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &here);
    MPI_Comm_size(here, &r->beside);
    MPI_Comm_free(&here);
    return NULL;
}

static void fail(const struct ranks *r)
{
    MPI_Abort(r->all, 1);
}

/* Wait until it is done. MPI's own calls wait by asking without end, which costs as much as work
 * does, and takes it from others where ranks share processors. So who waits asks for a while, and
 * then from time to time. To wake is work, too: each pause is a quarter longer than the one before,
 * and so about a fifth of what has been waited. */
static void finish(MPI_Request request)
{
    struct timespec pause = {0, PAUSE};
    int done = 0;
    for (int asked = 0; MPI_Test(&request, &done, MPI_STATUS_IGNORE), !done; asked++)
        if (asked >= ASKED_WITHOUT_PAUSE) {
            nanosleep(&pause, NULL);
            pause.tv_nsec += pause.tv_nsec < LONGEST ? pause.tv_nsec / 4 : 0;
        }
}

/* Wait until all are here: what is sent afterwards takes several steps, and who has slept long
 * would sleep long at each. */
static void meet(const struct ranks *r)
{
    MPI_Request request;
    MPI_Ibarrier(r->all, &request);
    finish(request);
}

/* Values of 8 bytes; ANY: ints. */
static void reduce(const struct ranks *r, enum reduction how, void *value, size_t count)
{
    const MPI_Datatype type = how == SUM_OF_COUNTS ? MPI_UINT64_T
                              : how == ANY         ? MPI_INT
                                                   : MPI_DOUBLE;
    const MPI_Op op = how == SUM || how == SUM_OF_COUNTS ? MPI_SUM : MPI_MAX;
    MPI_Request request;
    meet(r);
    for (size_t from = 0; from < count; from += PIECE) {
        const size_t n = count - from < PIECE ? count - from : PIECE;
        MPI_Iallreduce(MPI_IN_PLACE, (char *)value + 8 * from, (int)n, type, op, r->all, &request);
        finish(request);
    }
}

/* An item as MPI counts it. */
static MPI_Datatype type_of(size_t size)
{
    MPI_Datatype type;
    MPI_Type_contiguous((int)size, MPI_BYTE, &type);
    MPI_Type_commit(&type);
    return type;
}

/* By r->counts and places: of all in one array, */
static void gather(const struct ranks *r, void *array, size_t size)
{
    MPI_Datatype type = type_of(size);
    MPI_Request request;
    meet(r);
    MPI_Iallgatherv(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, array, r->counts, r->places, type, r->all,
                    &request);
    finish(request);
    MPI_Type_free(&type);
}

/* or from each to each. */
static void exchange(const struct ranks *r, const void *items, void *to, size_t size)
{
    MPI_Datatype type = type_of(size);
    MPI_Request request;
    meet(r);
    MPI_Ialltoallv(items, r->counts, r->places, type, to, r->counts + r->count,
                   r->places + r->count, type, r->all, &request);
    finish(request);
    MPI_Type_free(&type);
}

static void exchange_one(const struct ranks *r, const size_t *to_each, size_t *from_each)
{
    MPI_Request request;
    meet(r);
    MPI_Ialltoall(to_each, sizeof *to_each, MPI_BYTE, from_each, sizeof *from_each, MPI_BYTE,
                  r->all, &request);
    finish(request);
}

static void tell(const struct ranks *r, char *item, size_t size)
{
    MPI_Request request;
    meet(r);
    for (size_t from = 0; from < size; from += PIECE) {
        MPI_Ibcast(item + from, (int)(size - from < PIECE ? size - from : PIECE), MPI_BYTE, 0,
                   r->all, &request);
        finish(request);
    }
}

#else

static const char *join(struct ranks *r, const void *communicator)
{
    (void)r, (void)communicator;
    return "this library was built without MPI: make MPI=1";
}

static void fail(const struct ranks *r)
{
    (void)r;
}

static void reduce(const struct ranks *r, enum reduction how, void *value, size_t count)
{
    (void)r, (void)how, (void)value, (void)count;
}

static void gather(const struct ranks *r, void *array, size_t size)
{
    (void)r, (void)array, (void)size;
}

static void exchange(const struct ranks *r, const void *items, void *to, size_t size)
{
    (void)r, (void)items, (void)to, (void)size;
}

static void exchange_one(const struct ranks *r, const size_t *to_each, size_t *from_each)
{
    (void)r, (void)to_each, (void)from_each;
}

static void tell(const struct ranks *r, char *item, size_t size)
{
    (void)r, (void)item, (void)size;
}

#endif

struct ranks *ranks_open(const void *communicator, const char **cause)
{
    struct ranks *r = calloc(1, sizeof *r);
    *cause = r ? join(r, communicator) : "out of memory";
    if (!*cause) {
        r->counts = calloc(2 * (size_t)r->count, sizeof *r->counts);
        r->places = calloc(2 * (size_t)r->count, sizeof *r->places);
        if (!r->counts || !r->places)
            *cause = "out of memory";
    }
    if (!*cause)
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

int ranks_beside(const struct ranks *r)
{
    return r ? r->beside : 1;
}

const void *ranks_communicator(const struct ranks *r)
{
    return r ? &r->all : NULL;
}

void ranks_sends(struct ranks *r, enum ranks_kind kind, uint64_t bytes)
{
    if (r)
        r->sent[kind] += bytes;
}

uint64_t ranks_sent(const struct ranks *r, enum ranks_kind kind)
{
    return r ? r->sent[kind] : 0;
}

static void reduce_all(struct ranks *r, enum ranks_kind kind, enum reduction how, void *value,
                       size_t count)
{
    if (ranks_count(r) == 1)
        return;
    reduce(r, how, value, count);
    r->sent[kind] += 2 * 8 * count * (uint64_t)(r->count - 1) / (uint64_t)r->count;
}

void ranks_add_counts(struct ranks *r, enum ranks_kind kind, uint64_t *value, size_t count)
{
    reduce_all(r, kind, SUM_OF_COUNTS, value, count);
}

void ranks_starts(struct ranks *r, enum ranks_kind kind, size_t mine, size_t *first)
{
    const size_t ranks = (size_t)ranks_count(r);
    _Static_assert(sizeof(size_t) == sizeof(uint64_t), "counts are sent as they stand");
    memset(first, 0, (ranks + 1) * sizeof *first);
    first[ranks_number(r) + 1] = mine;
    ranks_add_counts(r, kind, (uint64_t *)first + 1, ranks);
    for (size_t k = 0; k < ranks; k++)
        first[k + 1] += first[k];
}

void ranks_add(struct ranks *r, enum ranks_kind kind, double *value, size_t count)
{
    reduce_all(r, kind, SUM, value, count);
}

void ranks_most(struct ranks *r, enum ranks_kind kind, double *value, size_t count)
{
    reduce_all(r, kind, MOST, value, count);
}

int ranks_any(struct ranks *r, int so)
{
    int any = so != 0;
    if (ranks_count(r) > 1)
        reduce(r, ANY, &any, 1);
    return any;
}

/* MPI counts by int: who has more is ended, as by any of its errors, before something else goes. */
static int count_of(const struct ranks *r, size_t count)
{
    if (count > INT_MAX)
        fail(r);
    return (int)count;
}

void ranks_complete(struct ranks *r, enum ranks_kind kind, void *array, size_t size,
                    const size_t *first)
{
    if (ranks_count(r) == 1 || first[r->count] == first[0])
        return;
    for (int k = 0; k < r->count; k++) {
        r->counts[k] = count_of(r, first[k + 1] - first[k]);
        r->places[k] = count_of(r, first[k]);
    }
    gather(r, array, size);
    r->sent[kind] += (first[r->number + 1] - first[r->number]) * size * (uint64_t)(r->count - 1);
}

void ranks_complete_parts(struct ranks *r, enum ranks_kind kind, void *array, size_t size,
                          size_t count)
{
    if (ranks_count(r) == 1)
        return;
    size_t *first = malloc(((size_t)r->count + 1) * sizeof *first);
    if (!first) {
        fail(r);
        return;
    }
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
    static const char nothing; /* Open MPI takes equal addresses for one array, if empty, too */
    size_t sent = 0, came = 0;
    for (int k = 0; k < n; k++) {
        r->counts[k] = count_of(r, count[k]);
        r->places[k] = count_of(r, sent);
        r->counts[n + k] = count_of(r, from[k]);
        r->places[n + k] = count_of(r, came);
        sent += count[k];
        came += from[k];
        r->sent[kind] += k == r->number ? 0 : count[k] * size;
    }
    exchange(r, sent ? items : &nothing, to, size);
}

void *ranks_exchange(struct ranks *r, enum ranks_kind kind, const void *items, size_t size,
                     const size_t *count, size_t *from)
{
    size_t all = 0;
    from[0] = count[0];
    if (ranks_count(r) > 1)
        exchange_one(r, count, from);
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
    tell(r, item, size);
    r->sent[kind] += r->number == 0 ? size * (uint64_t)(r->count - 1) : 0;
}
