/* ranks.h - processes that work on one thing together, on one machine or on many: what they tell
 * each other.
 *
 * All of a run's processes, its ranks, make the same calls in the same order; each call below but
 * the first three waits for all of them. NULL is a run of one process, in which every call does
 * nothing and costs nothing. Built without MPI there is no other (make MPI=1).
 *
 * Invariant: no result depends on who is told first. Counts are added as integers; of a sum of
 * doubles the last bit may depend on how many ranks there are, so it decides nothing but when
 * iteration ends and what people read.
 *
 * Should a message fail, MPI ends the whole run: there is nothing to be said without it.
 * SPDX-License-Identifier: MIT */
#ifndef RANKS_H
#define RANKS_H

#include <stddef.h>
#include <stdint.h>

/* What is told, for the account of bytes. */
enum ranks_kind {
    RANKS_SPLITS,    /* which elements a pass has split */
    RANKS_LINKS,     /* links that go to the rank that has their receiver */
    RANKS_SWEEPS,    /* radiosities of emitters, while sweeps go on */
    RANKS_VALUES,    /* what elements have, to all */
    RANKS_PARTICLES, /* counts of particles and paths */
    RANKS_PAIRS,     /* what came of pairs that are dealt out */
    RANKS_KINDS
};

struct ranks;

/* Over an MPI communicator (communicator: the address of an MPI_Comm), of which it makes its own.
 * NULL, with *cause set: built without MPI, MPI not started, or out of memory. */
struct ranks *ranks_open(const void *communicator, const char **cause);
void ranks_close(struct ranks *r);

int ranks_count(const struct ranks *r);
int ranks_number(const struct ranks *r); /* of this one, from 0 */
int ranks_beside(const struct ranks *r); /* on this one's machine, it among them */

/* The address of its MPI_Comm, for others that send over it; NULL: one process. What they send they
 * tell of. */
const void *ranks_communicator(const struct ranks *r);
void ranks_sends(struct ranks *r, enum ranks_kind kind, uint64_t bytes);

/* Bytes that this rank has sent so far: of what all are told, to each of the others; of sums, as a
 * ring takes them. */
uint64_t ranks_sent(const struct ranks *r, enum ranks_kind kind);

/* Sums, or the largest, of all ranks' value[count], which all then have. */
void ranks_add_counts(struct ranks *r, enum ranks_kind kind, uint64_t *value, size_t count);
void ranks_add(struct ranks *r, enum ranks_kind kind, double *value, size_t count);
void ranks_most(struct ranks *r, enum ranks_kind kind, double *value, size_t count);

/* The least of all ranks' counts, below 2^53. */
static inline size_t ranks_least(struct ranks *r, enum ranks_kind kind, size_t count)
{
    double least = -(double)count;
    ranks_most(r, kind, &least, 1);
    return (size_t)-least;
}

/* Is the number the same on all ranks? */
static inline int ranks_alike(struct ranks *r, enum ranks_kind kind, uint64_t number)
{
    const double high = (double)(number >> 32), low = (double)(uint32_t)number;
    double most[4] = {high, low, -high, -low};
    ranks_most(r, kind, most, 4);
    return most[0] <= -most[2] && most[1] <= -most[3];
}

/* Is it so (not 0) on any rank? */
int ranks_any(struct ranks *r, int so);

/* Each rank makes so many items of one array: first[ranks + 1], where each one's begin. */
void ranks_starts(struct ranks *r, enum ranks_kind kind, size_t mine, size_t *first);

/* An array of items of `size` bytes, of which rank k has made first[k] .. first[k + 1] - 1: then
 * all ranks have all. */
void ranks_complete(struct ranks *r, enum ranks_kind kind, void *array, size_t size,
                    const size_t *first);

/* The part of 0 .. count - 1 that falls to rank k begins at: equal parts, in order. */
static inline size_t ranks_part(const struct ranks *r, size_t count, int k)
{
    size_t n = (size_t)ranks_count(r), i = (size_t)k;
    return count / n * i + count % n * i / n;
}

/* The same of an array in equal parts. */
void ranks_complete_parts(struct ranks *r, enum ranks_kind kind, void *array, size_t size,
                          size_t count);

/* Items of `size` bytes, count[k] of them for rank k, one rank's after the other's: returns those
 * that came, in the order of their senders, which the caller frees, and sets from[ranks] to how
 * many each sent. NULL when out of memory. */
void *ranks_exchange(struct ranks *r, enum ranks_kind kind, const void *items, size_t size,
                     const size_t *count, size_t *from);

/* The same into `to`, where so many are known to come. */
void ranks_exchange_known(struct ranks *r, enum ranks_kind kind, const void *items, size_t size,
                          const size_t *count, void *to, const size_t *from);

/* From rank 0 to all. */
void ranks_tell(struct ranks *r, enum ranks_kind kind, void *item, size_t size);

#endif
