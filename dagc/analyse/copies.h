/* copies.h - the nodes of a graph, each once for each knowledge of the terms that paths bring.
 * SPDX-License-Identifier: MIT */
#ifndef COPIES_H
#define COPIES_H

#include "analyse/analyse.h"

/* By term: the least and the highest level that it may have. */
struct knowledge {
    unsigned char *low, *high;
};

struct copy {
    int place;   /* of its node, in the oracle's order */
    int number;  /* among that node's copies, from 0 */
    int next;    /* the next of them, in items; -1 */
    int arcs_in; /* how many arcs and entries lead to it */
    int checks;  /* how many of the node's needs its paths leave open */
    int *ways;   /* by answer, in ways; -1: a decision */
    struct knowledge known;
};

/* Where an arc leads: to a copy, or to one of two ways, by a look at a level. */
struct way {
    int term, cut; /* cut 0: to the copy `below`; else the term is looked at: is it at `cut`? */
    int below, above;
    int checked; /* the look is a check of the data manager: no tool before it has settled it */
};

/* Is the term at the level? Then the number of a start is larger by `weight`. */
struct look {
    int term, level, weight;
};

struct copies {
    struct copy *items;
    int count;
    int *first; /* by place: its first copy, the others by `next` */
    struct way *ways;
    int way_count;
    int nothing; /* the way in where nothing is known */
    int general; /* for what is not foreseen: to the general copies */
    struct look *looks;
    int look_count;
    int *starts; /* by number: the way in, in ways */
    int start_count;
};

/* At most `most` times as many copies as nodes. The first of each node is general: it has what is
 * known on every path from any start. With `most` 1 there are no others. */
struct copies dag_copies(struct dag *dag, const struct oracle_graph *oracle, int most);

#endif
