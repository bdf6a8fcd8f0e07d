/* trace.h - whoever wants to be told of every discussion.
 *
 * The threads of a round note what each discussion came to, in its pair's place; then the thread
 * that called in tells it, pair by pair, before anything is split or linked: elements are as the
 * oracle saw them. So the order is that of the pairs, on any number of threads.
 * SPDX-License-Identifier: MIT */
#ifndef TRACE_H
#define TRACE_H

#include "engine/refine.h"
#include "radiosity.h"

/* What the discussion of one pair came to: [0] as it stands, [1] the other way round. */
struct traced_pair {
    uint64_t way[2];
    double form_factor[2], visibility[2];
    uint32_t rays[2];
    unsigned char form_factor_level[2], visibility_level[2];
    struct blockers between; /* the list when the second began */
};

struct trace {
    RadTraceFunction tell;
    void *user;
    int pass;                  /* from 1: before the first solve */
    int stopped;               /* the function wanted no more */
    struct traced_pair *pairs; /* [of the round] */
};

/* Ask the oracle, and note what came of it. */
enum decision trace_ask(struct traced_pair *out, int turned, const struct refiner *refiner,
                        struct discussion *d);

/* Tell of the discussion of a link that began with the values of `before` and this list. Returns 0,
 * or -1: no more. */
int trace_tell(struct trace *trace, const struct refinement *r, size_t i, int turned,
               const struct link *before, const struct blockers *list);

#endif
