/* guard.h - what a tool that guards says, with the arguments of one node (guard.c).
 * SPDX-License-Identifier: MIT */
#ifndef GUARD_H
#define GUARD_H

#include "analyse/analyse.h"
#include "check/interval.h"

/* Do the node's answers allow what its tool declares that they allow? */
int dag_guard_holds(const struct dag *dag, const struct node *node);
/* Are the limits it goes by 0 unless somebody sets a parameter? */
int dag_guard_idle(const struct dag *dag, const struct node *node);

/* For messages: why it does not hold; "min_area = 0 and min_share = 0" for `with` " = 0"; which
 * decisions an answer allows ("a, b"; decision -1), or which answers allow a decision ("a | b";
 * answer -1). */
const char *dag_guard_fault(struct dag *dag, const struct node *node);
const char *dag_guard_limits(struct dag *dag, const struct tool *tool, const char *with);
const char *dag_label_list(struct dag *dag, struct span labels); /* "a | b" */
const char *dag_guard_allows(struct dag *dag, const struct tool *tool, int answer, int decision);

/* By place: does every path to the node hold an answer that allows the decision? (Paths that
 * contradict themselves are paths here.) */
void dag_allowed(struct dag *dag, const struct oracle_graph *oracle, int decision,
                 unsigned char *allowed);

#endif
