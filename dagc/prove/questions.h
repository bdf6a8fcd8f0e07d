/* questions.h - of two graphs: which nodes ask the same, and what lies before each.
 *
 * A question is a tool and its arguments, parameters by name, numbers by value; its base is equal
 * wherever it is asked, on either side. What it answers depends on the terms that it finds, too.
 * SPDX-License-Identifier: MIT */
#ifndef QUESTIONS_H
#define QUESTIONS_H

#include "base/internal.h"

enum { SIDES = 2 };

/* A tool with its arguments: equal numbers, equal questions but for the terms. */
struct question {
    int side, node; /* where it was first seen */
};

/* What is asked in one of the graphs. */
struct asking {
    struct dag *dag;
    const struct oracle_graph *oracle;
    int *base;            /* by order: in bases */
    unsigned char *reach; /* [order][bases, then terms, in bits]: is it asked or read from here? */
    uint64_t *subgraph;   /* by order: a hash of all that follows */
};

struct questions {
    struct asking side[SIDES];
    struct question *bases;
    int base_count, bytes; /* bytes: of a row of reach */
};

/* Find the rest of what stands there from each side's dag and oracle. */
void dag_questions_find(struct questions *all, struct arena *arena);

int dag_same_number(double x, double y);

/* A hash of both, in their order. */
static inline uint64_t dag_mix(uint64_t x, uint64_t y)
{
    x = (x ^ y) * UINT64_C(0x9e3779b97f4a7c15);
    return x ^ x >> 29;
}

/* Equal where all that follows is. */
static inline uint64_t dag_subgraph_of(const struct asking *side, const struct target *target)
{
    return target->kind == TARGET_NODE ? side->subgraph[side->dag->nodes[target->index].order]
                                       : dag_mix(3, (uint64_t)target->index);
}

#endif
