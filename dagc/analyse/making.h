/* making.h - copies of nodes while they are made: what copies.c, copies_starts.c and copies_told.c
 * share.
 * SPDX-License-Identifier: MIT */
#ifndef MAKING_H
#define MAKING_H

#include "analyse/copies.h"

enum { CUTS = 64 }; /* levels above are not told apart */

struct making {
    struct dag *dag;
    const struct oracle_graph *oracle;
    struct copies *copies;
    uint64_t *told;      /* by term: bit L, knowledge of level L is told apart */
    uint64_t *early;     /* where a discussion begins already */
    uint64_t *cuts;      /* by term and place: those of them that somebody from here on asks for */
    unsigned char *left; /* by decision and term: the level that every path to it leaves; 0: none */
    int terms;
    size_t most; /* copies */
    int kept;    /* may discussions begin with something? If not, nothing is general */
    int general; /* are the general copies being made? They lead to each other, without looks */
};

/* copies.c */
int dag_making_finest(const struct dag *dag, int term);
uint64_t dag_making_bit(int level); /* 0: it is not told apart */
/* The levels of a term that the node itself asks for. */
uint64_t dag_making_asked(const struct dag *dag, const struct node *node, int term);
/* A way from outside to the first node. */
int dag_making_entry(struct making *m, struct knowledge known);
struct knowledge dag_making_knowledge(const struct making *m); /* nothing is known */
void dag_making_copy(const struct making *m, struct knowledge to, struct knowledge from);
/* All copies, by what is told apart now. Returns 0, or -1: there would be too many. */
int dag_making_copies(struct making *m);

/* copies_starts.c */
/* What the paths to decisions leave, in m->left. */
void dag_making_find_left(struct making *m);
/* The ways in of discussions that begin with that, where `any` is what others may begin with. */
void dag_making_starts(struct making *m, struct knowledge any);

/* copies_told.c */
/* Tells apart what most checks hang on, then what next most do, as far as the copies allow; and
 * then as early as they allow. */
void dag_making_tell_apart(struct making *m);

#endif
