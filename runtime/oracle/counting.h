/* counting.h - what a thread counts of an interpreted graph: counting.c fills it, statistics.c adds
 * it up.
 * SPDX-License-Identifier: MIT */
#ifndef COUNTING_H
#define COUNTING_H

#include "oracle/counted_host.h"
#include "oracle/program.h"
#include "oracle/tool_table.h"
#include "radiosity.h"

/* Discussions that went one way through the graph. */
struct path_count {
    uint64_t number, count; /* count 0: a free place */
    uint64_t timed, nanoseconds;
};

/* What a step of a timed discussion took: where its numbers are, and how long. */
struct span_of_step {
    uint64_t *numbers, nanoseconds;
};

/* One thread's counters of one program. */
struct tally {
    const void *owner;  /* address of the thread's `mine`: no two living threads have the same */
    struct tally *next; /* of the program */
    struct counted_host host;
    uint64_t *levels; /* of all terms before the node, eight in each */
    int wait;         /* this many discussions on, one is timed */
    uint32_t random;
    uint64_t *called;           /* per step, how often before this block */
    uint64_t path;              /* of the discussion that goes on */
    struct span_of_step *spans; /* [span_count], of a timed one: at most one per step */
    size_t span_count;
    struct path_count *paths; /* [path_capacity], a power of 2: by a hash of the number */
    size_t path_count, path_capacity;
    uint64_t counts[RAD_COUNTS], bins[RAD_RECORDS][RAD_BINS], zero[RAD_RECORDS];
    /* [program.number_count]: per arc, as program.next, how often it was taken; then per step
     * program_stride() of them */
    uint64_t numbers[];
};

/* Of a step: timed calls, ns in them, rays, blocks in which a pair came by, the vectors of 4, 8 and
 * 16 pairs that those take, and per term of the catalog how often it was computed. */
enum {
    NUMBER_TIMED,
    NUMBER_NANOSECONDS,
    NUMBER_RAYS,
    NUMBER_LISTS,
    NUMBER_VECTORS,
    NUMBER_TERMS = NUMBER_VECTORS + RAD_WIDTHS
};

static inline uint64_t program_stride(void)
{
    return (uint64_t)(NUMBER_TERMS + term_table_count);
}

#endif
