/* analyse.h - what the analyses of a checked graph share: the search for a path, and words.
 *
 * No analysis walks over paths to find out something: paths are exponentially many. Each sweeps
 * the nodes once or a few times in topological order, and only what is reported looks for one
 * shortest path that proves it, the witness.
 * SPDX-License-Identifier: MIT */
#ifndef ANALYSE_H
#define ANALYSE_H

#include "base/warn.h"

/* A breadth-first search over pairs (node, phase): the phase is what the path has met so far. */
struct search {
    struct dag *dag;
    const struct oracle_graph *oracle;
    int phases; /* 1 or 2; a path starts in phase 0 */
    /* The phase after `answer` of `node`; -1: no path of interest goes on there. */
    int (*step)(const struct search *search, const struct node *node, int answer, int phase);
    const void *context;
    int *from;   /* by state, order * phases + phase: the state before it; -1 start, -2 unseen */
    int *answer; /* by state: the answer of the state before it that leads here */
    int *queue;
};

/* Room for a search of any graph of the dag in up to two phases, used again for each witness. */
struct search dag_search_new(struct dag *dag);

/* Fills in from and answer for all that can be reached. */
void dag_search(struct search *search, const struct oracle_graph *oracle, int phases,
                int (*step)(const struct search *, const struct node *, int, int),
                const void *context);

/* Is there such a path to the node? */
int dag_search_reached(const struct search *search, const struct node *node, int phase);

/* "start -> level(surfaces) -> planes(toward) -> seen": the path to a node, and through `answer`
 * (-1: none) of it to `end` (NULL: none); the middle left out when it is long. */
const char *dag_search_path(const struct search *search, const struct node *node, int phase,
                            int answer, const char *end);

/* The first node after which the path to the node in phase 1 is in that phase; NULL: none. */
const struct node *dag_search_turn(const struct search *search, const struct node *node);

/* ---- analyse.c: words and small facts */

const char *dag_answer_name(const struct dag *dag, const struct node *node, int answer);
const char *dag_target_name(const struct dag *dag, const struct target *target);
int dag_same_target(const struct target *a, const struct target *b);
int dag_reads_term(const struct dag *dag, struct span needs, int term); /* is it among them? */
/* The value, whole and the same for the same value: names resolved, operators in parentheses. */
const char *dag_value_text(struct dag *dag, int expression);
/* "transfer(absolute = epsilon)" */
const char *dag_call_text(struct dag *dag, const struct node *node);
/* The same as the language reads it: that a name is an extern's is not told. */
const char *dag_call_source(struct dag *dag, const struct node *node);
const char *dag_need_text(struct dag *dag, const struct need *need); /* "form_factor >= polygon" */
/* ", a, b or c": appends a name to a list, for sentences. */
const char *dag_join(struct dag *dag, const char *list, const char *name);
/* Can asking a node change what the question of node `asked` answers the next time? `same`: it is
 * the same question, its tool and all arguments. */
int dag_may_change(const struct dag *dag, const struct node *node, const struct node *asked,
                   int same);

/* ---- the passes of dag_analyse */

void dag_analyse_use(struct dag *dag);     /* what nothing leads to or uses */
void dag_analyse_answers(struct dag *dag); /* answers that are hidden or make no difference */
void dag_analyse_numbers(struct dag *dag); /* arguments that are no number */
void dag_analyse_terms(struct dag *dag);   /* terms that paths lack, or compute for nothing */
void dag_analyse_guards(struct dag *dag);  /* subdivisions that nothing allows */
void dag_analyse_repeats(struct dag *dag); /* what has been asked before */

/* The level, by place in the oracle's order, at which the term is surely known when the node is
 * reached; 0: some path leaves it absent. */
void dag_sure_levels(const struct dag *dag, const struct oracle_graph *oracle, int term,
                     unsigned char *sure);
/* By place: may the term be known when the node is reached? */
void dag_possible_terms(const struct dag *dag, const struct oracle_graph *oracle, int term,
                        unsigned char *possible);
/* Does a decision read the term? Then a discussion gives it back, and may be handed it again. */
int dag_is_kept(const struct dag *dag, int term);
/* The least level that the tool leaves the term at with this answer, 0: it does not write it (-1:
 * with any that does not refuse); and that asking the node leaves it at, whose arguments may have
 * read it. */
int dag_written_level(const struct dag *dag, const struct tool *tool, int answer, int term);
int dag_left_level(const struct dag *dag, const struct node *node, int answer, int term);

#endif
