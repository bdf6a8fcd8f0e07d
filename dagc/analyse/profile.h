/* profile.h - what a program measured of an oracle's nodes: --profile.
 * SPDX-License-Identifier: MIT */
#ifndef PROFILE_H
#define PROFILE_H

#include "base/internal.h"

/* Pairs of a block that runs in waves: as WAVE_PAIRS of runtime/wave.h. */
enum { DAG_WAVE_PAIRS = 256 };
/* Pairs that are treated at once: of how many a vector is, in the order of measured.vectors. */
enum { PROFILE_WIDTHS = 3 };
extern const int dag_profile_widths[PROFILE_WIDTHS];

/* One node. */
struct measured {
    double calls;
    double seconds;                 /* of one call; 0: not measured */
    double lists;                   /* blocks in which some pair came by; 0: not measured */
    double vectors[PROFILE_WIDTHS]; /* that the pairs of those lists fill, the last in part */
    const double *answers;          /* by arc: how often */
};

struct profile {
    int oracle;             /* in oracles */
    struct measured *nodes; /* by the index in nodes, of those that the start reaches */
    /* dag_order_questions: the graph that was measured; a sentence of each two questions that could
     * change places, and whether some did */
    struct oracle_graph before;
    const char **told; /* [told_count] */
    int told_count, ordered;
};

/* Reads a program's statistics: {"oracle": NAME, "nodes": [{"node", "tool", "calls", "answers":
 * [{"answer", "count"}], and where there are "mean_seconds", "lists", "vectors": {"4", "8",
 * "16"}}]}.
 * NULL after an error: it is no such file, or of another oracle than the dag's. */
struct profile *dag_read_profile(struct dag *dag, const struct input *input);

#endif
