/* statistics.h - how often each node of an interpreted graph was asked, and each of its answers
 * given.
 *
 * [Turbet & Sillion, section 4.3: "statistics are easily generated on the nodes of the graph"]
 * SPDX-License-Identifier: MIT */
#ifndef STATISTICS_H
#define STATISTICS_H

#include "oracle/refiner.h"

enum { STATISTICS_COUNTS = 256, STATISTICS_SLOTS = 8, STATISTICS_LOW = -64, STATISTICS_HIGH = 64 };

/* One answer of one node. */
struct answer_statistics {
    /* kind: "precise", "approximate", "other", or "command" when it answers nothing */
    const char *name, *kind;
    const char *target; /* the node or decision it leads to */
    uint64_t count;
};

struct node_statistics {
    const char *name, *tool; /* a node inside a branch: USE__NAME */
    uint64_t calls;
    /* [answer_count], in the order of the tool's declaration */
    const struct answer_statistics *answers;
    int answer_count;
};

/* A histogram that `record` made: how many values lay in [2^(LOW + i), 2^(LOW + i + 1)), the first
 * and last bin open to their sides, and how many were not above 0. */
struct record_statistics {
    uint64_t zero, bins[STATISTICS_HIGH - STATISTICS_LOW];
};

struct statistics {
    struct node_statistics *nodes; /* [node_count], in topological order: the start first */
    int node_count;
    struct answer_statistics *answers;  /* of all nodes */
    uint64_t counts[STATISTICS_COUNTS]; /* what `count` counted, by its `as` */
    struct record_statistics records[STATISTICS_SLOTS];
};

/* From now on count what the refiner does, on whatever threads it is asked; begins at 0 again.
 * Decisions stay the same. Returns 0, or -1 when it is no interpreted graph. Not while it is being
 * asked. */
int refiner_count(struct refiner *refiner);

/* What was counted since, all threads together. Not while it is being asked. Names are the
 * refiner's. Returns 0, or -1 when out of memory or when nothing is counted. */
int statistics_take(struct statistics *s, const struct refiner *refiner);
void statistics_free(struct statistics *s);

#endif
