/* shared.h - graphs that an oracle uses more than once, as pieces that could be one function.
 * SPDX-License-Identifier: MIT */
#ifndef SHARED_H
#define SHARED_H

#include "analyse/analyse.h"

/* All uses of one branch: the same nodes, once for each use. What differs is where it is left for,
 * and arguments made of numbers, parameters and facts. */
struct shared {
    int branch;
    int uses, nodes; /* how many uses, of how many nodes each */
    int *node;       /* [uses * nodes], in nodes: of each use, in the oracle's order */
    int exits;
    int *exit;    /* [uses * exits]: an arc, in arcs, of that use that leaves by this exit */
    int *exit_of; /* by node and answer (first_answer[node] + answer): its exit; -1: it stays */
    int *first_answer; /* [nodes] */
    int different;     /* arguments that differ */
    int *argument;     /* [uses * different], in arguments */
    /* Arguments that may be no number in some use: what is said of them names the use's node. */
    int doubts;
    int *doubt, *doubt_node; /* [uses * doubts], in arguments and in nodes */
};

/* Of an oracle; they have no node in common. Returns how many. */
int dag_find_shared(struct dag *dag, const struct oracle_graph *oracle, struct shared **shared);

/* Which of the arguments that differ is it? Of the first use; -1: none of them. */
int dag_shared_argument(const struct shared *shared, int argument);
int dag_shared_doubt(const struct shared *shared, int argument); /* likewise of the doubts */

#endif
