/* statistics.h - what an interpreted graph did: how often each node was asked and each answer
 * given, what it cost, and which ways were gone.
 *
 * [Turbet & Sillion, section 4.3: "statistics are easily generated on the nodes of the graph"]
 * SPDX-License-Identifier: MIT */
#ifndef STATISTICS_H
#define STATISTICS_H

#include "oracle/refiner.h"
#include "radiosity.h"

/* Of a histogram that `record` made: bin i holds values in [2^(LOW + i), 2^(LOW + i + 1)), the
 * first and last bin open to their sides. */
enum { STATISTICS_LOW = -RAD_BINS / 2, STATISTICS_HIGH = RAD_BINS / 2 };

struct statistics {
    struct RadStatistics shown; /* into what follows; names are the refiner's */
    struct RadNodeCount *nodes; /* of all together, then of each pass */
    struct RadAnswerCount *answers;
    struct RadTermCount *terms;
    struct RadPass *passes;
    struct RadPath *paths;
    int *steps; /* of the paths */
    uint64_t counts[RAD_COUNTS], bins[RAD_RECORDS][RAD_BINS], zero[RAD_RECORDS];
};

/* From now on count what the refiner does, on whatever threads it is asked; begins at 0 again.
 * Decisions stay the same. Returns 0, or -1 when it is no interpreted graph or out of memory. Not
 * while it is being asked. */
int refiner_count(struct refiner *refiner);

/* A pass of refinement is over: what is counted later is of the next. Not while it is being asked.
 * Returns 0, also when nothing is counted, or -1 when out of memory. */
int statistics_end_pass(const struct refiner *refiner);

/* What was counted since, all threads together. Not while it is being asked. Returns 0, or -1 when
 * out of memory or when nothing is counted. */
int statistics_take(struct statistics *s, const struct refiner *refiner);
void statistics_free(struct statistics *s);

#endif
