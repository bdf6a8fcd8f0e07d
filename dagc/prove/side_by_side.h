/* side_by_side.h - two graphs walked side by side: on which ways do they decide differently?
 * SPDX-License-Identifier: MIT */
#ifndef SIDE_BY_SIDE_H
#define SIDE_BY_SIDE_H

#include "prove/questions.h"

enum { WAYS_SHOWN = 20, WAYS_MAX = 1000 };

/* A graph, and how it is called where ways are shown; catalogs are the same. */
struct compared {
    struct dag *dag;
    const struct oracle_graph *oracle;
    const char *path;
};

struct differences {
    int ways;   /* to decide that differ, by what was asked last on either side; WAYS_MAX or more */
    int states; /* that were looked at */
    int cut;    /* 1: there are more than are looked at */
};

/* side: SIDES of them. Prints the first WAYS_SHOWN ways that differ to `out`, unless it is NULL.
 * Inside dag_protect of whatever the arena belongs to. */
struct differences dag_walk_both(const struct compared *side, struct arena *arena, FILE *out);

#endif
