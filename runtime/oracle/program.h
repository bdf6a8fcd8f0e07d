/* program.h - an oracle ready to be interpreted: what interpreter.c builds and walks, arguments.c
 * evaluates, counting.c counts and statistics.c adds up.
 * SPDX-License-Identifier: MIT */
#ifndef PROGRAM_H
#define PROGRAM_H

#include <stdatomic.h>
#include "dag.h"
#include "oracle/refiner.h"
#include "util/messages.h"

/* One operation of a computed step: a number, something read, or an operator on the top of the
 * stack. */
struct instruction {
    enum expression_kind kind;
    int level;
    double number;
    double (*term)(struct discussion *d, int level);
    double (*fact)(const struct discussion *d); /* or an extern */
};

enum { STACK_MAX = EXPRESSION_DEPTH + 100 };

/* An argument that may be no number, as 0 / 0: what its tool is given then, and what is said. As
 * value_checked of the flat release. */
struct doubtful {
    int argument; /* of the step */
    double low, high, instead;
    const char *what;
};

/* What `arguments` of a computed step points to. */
struct computed {
    double unused; /* so that a pointer to double may point here */
    int (*call)(struct discussion *d, const double *arguments);
    struct instruction *code;
    int count;
    int argument, argument_count;  /* in program.expressions */
    const struct doubtful *doubts; /* [doubt_count] */
    int doubt_count;
};

struct step {
    int (*call)(struct discussion *d, const double *arguments);
    const double *arguments;
    const int *next;  /* [answers]: a step, or ~decision */
    enum keeps keeps; /* what a counting walk keeps of the arguments */
};

struct program {
    struct step *steps;
    struct oracle_parameter *parameters;
    double *arguments; /* of all steps */
    int *expressions;  /* of all steps: which expression gives each argument */
    int *next;         /* of all steps */
    struct computed *computed;
    int computed_count;
    struct instruction *code;    /* of all computed steps */
    struct doubtful *doubts;     /* likewise */
    struct instruction *externs; /* per callback of the dag: its function, NULL when not given */
    int argument_count;
    struct dag *dag;
    int first_parameter; /* of the oracle, in dag->parameters */
    const struct oracle_graph *graph;
    int *reads; /* [read_count], enum catalog_fact */
    int read_count;
    int answer_count;     /* of all steps */
    uint64_t *ways;       /* of all steps, as next: see follow.h; NULL: not numbered, or too many */
    char fingerprint[17]; /* the graph's, as compiled releases have it */
    char *graph_json;     /* made when asked for; NULL: not yet */
    uint64_t counting;    /* which of all countings this is; 0: nothing is counted */
    struct program *self; /* so that a walk, which has a const one, can add its thread's counters */
    void (*forget)(struct program *p); /* frees what counting made; NULL: nothing was counted */
    _Atomic(struct tally *) tallies;   /* one per thread that has asked */
    atomic_int lost;                   /* there was no memory for one */
    uint64_t clock;                    /* what reading the clock takes, ns */
    /* [pass_count][number_count]: all tallies' numbers together at the end of each pass */
    uint64_t *passes;
    size_t pass_count, pass_capacity, number_count;
};

/* arguments.c. The call of a step with computed arguments, and those arguments alone, on a stack
 * of STACK_MAX. */
int program_compute(struct discussion *d, const double *arguments);
void program_evaluate(struct discussion *d, const struct computed *c, double *stack);

/* Make the steps that need it computed ones. 0, or -1 after a message. */
int program_link(struct program *p, const struct oracle_graph *g, struct messages *messages);

/* Evaluate what is fixed, once, and not in the walk. */
void program_prepare(struct refiner *r);

/* interpreter.c. `state` is the steps. */
enum decision program_walk(const void *state, struct discussion *d);

/* counting.c. The walk that counts. `state` is the program. */
enum decision program_walk_counted(const void *state, struct discussion *d);

#endif
