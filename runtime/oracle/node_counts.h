/* node_counts.h - what a graph was asked: calls, time and answers of each node, to be printed.
 *
 * It is of no domain and of any release. Of text made by dagc --instrument for the oracle NAME,
 * NODE_COUNTS(NAME, &counters) gives it; of an interpreted graph node_counting.h does. Threads
 * count apart; NODE_COUNTS_ADD puts theirs together. C11 and C++11.
 * SPDX-License-Identifier: MIT */
#ifndef NODE_COUNTS_H
#define NODE_COUNTS_H

#include <stdio.h>
#include <string.h>
#include <time.h>

/* All arrays are somebody else's. Nodes stand in the order in which a discussion meets them. */
struct node_counts {
    int nodes, arcs;
    const char *const *node_names, *const *arc_names; /* [nodes], [arcs]: of nodes, of answers */
    const int *arc_nodes;                             /* [arcs]: the node that it leaves */
    const unsigned long long *calls, *answers;        /* [nodes], [arcs] */
    const double *time;                               /* [nodes], s; 0 if there was no clock */
};

static inline struct node_counts node_counts_of(int nodes, const char *const *node_names, int arcs,
                                                const char *const *arc_names, const int *arc_nodes,
                                                const unsigned long long *calls,
                                                const unsigned long long *answers,
                                                const double *time)
{
    struct node_counts counts;
    counts.nodes = nodes;
    counts.arcs = arcs;
    counts.node_names = node_names;
    counts.arc_names = arc_names;
    counts.arc_nodes = arc_nodes;
    counts.calls = calls;
    counts.answers = answers;
    counts.time = time;
    return counts;
}

#define NODE_COUNTS(name, counters) \
    node_counts_of(name##_nodes, name##_node_names, name##_arcs, name##_arc_names, \
                   name##_arc_nodes, (counters)->calls, (counters)->arcs, (counters)->time)

/* What one thread counted, added to another's structure of the same type. */
#define NODE_COUNTS_ADD(name, sum, counters) \
    do { \
        for (int i_ = 0; i_ < name##_nodes; i_++) { \
            (sum)->calls[i_] += (counters)->calls[i_]; \
            (sum)->time[i_] += (counters)->time[i_]; \
        } \
        for (int i_ = 0; i_ < name##_arcs; i_++) \
            (sum)->arcs[i_] += (counters)->arcs[i_]; \
        (sum)->checks += (counters)->checks; \
    } while (0)

/* A clock for the counters: the processor's seconds of the whole program. */
static inline double node_counts_seconds(void *context)
{
    (void)context;
    return (double)clock() / (double)CLOCKS_PER_SEC;
}

/* A line for each node: how often it was asked, for how long, and what it said. */
static inline void node_counts_print(FILE *out, struct node_counts counts)
{
    int width = 4;
    for (int i = 0; i < counts.nodes; i++)
        if (width < (int)strlen(counts.node_names[i]))
            width = (int)strlen(counts.node_names[i]);
    fprintf(out, "%-*s %12s %11s  answers\n", width, "node", "calls", "seconds");
    for (int i = 0; i < counts.nodes; i++) {
        fprintf(out, "%-*s %12llu %11.3g ", width, counts.node_names[i], counts.calls[i],
                counts.time[i]);
        for (int arc = 0; arc < counts.arcs; arc++)
            if (counts.arc_nodes[arc] == i)
                fprintf(out, " %s %llu", counts.arc_names[arc], counts.answers[arc]);
        fprintf(out, "\n");
    }
}

#endif
