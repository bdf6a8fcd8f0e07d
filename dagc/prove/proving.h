/* proving.h - a proof under way: what prove.c, scripted.c, walk.c and described.c share.
 * SPDX-License-Identifier: MIT */
#ifndef PROVING_H
#define PROVING_H

#include "base/internal.h"
#include "prove/proof.h"

struct proof {
    struct dag *dag;
    const struct emit_options *options;
    const struct dag_compiler *compiler;
    FILE *report;
    void *handle; /* dlopen's */
    const struct prove_library *library;
    const struct oracle_graph *oracle;
    int number;      /* of the oracle */
    int width;       /* arguments of the tool that has most */
    int term_values; /* numbers in all terms */
    /* What parameters, facts and externs, terms are: see walk.c. */
    double *values, *facts, *known;
    double *asked; /* [width]: the arguments of one call */
    unsigned char *script, *start;
    struct prove_record wanted, got;
    int *nodes; /* by call of the path that was walked last: its node's place in the order */
    unsigned char *told; /* by the same: some argument up to it was no number */
    uint64_t random;
    int different; /* a difference has been reported */
};

/* scripted.c. Compiles the oracles under scripted tools, by both releases. 0, or -1 after a
 * message. Changes the headers named in the dag. */
int prove_build(struct proof *proof);

/* walk.c. Room for the oracle that is to be proved next. */
void prove_prepare(struct proof *proof);

/* The values that parameters, facts and terms have, in one of PROVE_VALUES ways: all apart; as the
 * author gave them; all at the low or at the high end of what is declared, or each at some end; all
 * others at random, within what is declared. */
enum { PROVE_LOW = 2, PROVE_HIGH, PROVE_ENDS, PROVE_VALUES = 8 };
void prove_choose_values(struct proof *proof, int way);

/* Walks the graph and runs a release along the script. 0, or 1 after a report of what they differ
 * in. */
int prove_try(struct proof *proof, enum prove_flavour flavour);
const char *prove_flavour_name(struct dag *dag, enum prove_flavour flavour);

/* described.c. What the releases say of themselves: 0, or 1 after a report. */
int prove_descriptions(struct proof *proof);

/* states.c. How far a release was walked. */
struct prove_extent {
    long starts, states, walks; /* walks: paths that were run */
    int cut;                    /* there are too many states: it is a sample */
};

/* Every way through a release, from the first discussion of a pair alone or from all that may be
 * known of it. */
void prove_states(struct proof *proof, enum prove_flavour flavour, int all_starts,
                  struct prove_extent *extent);

const struct node *prove_node_at(const struct proof *proof, int place);

#endif
