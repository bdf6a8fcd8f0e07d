/* resolve.h - what the two resolvers share.
 * SPDX-License-Identifier: MIT */
#ifndef RESOLVE_H
#define RESOLVE_H

#include "base/internal.h"

/* The names that one graph declares. */
struct scope {
    struct oracle_graph *graph;
    struct table nodes, parameters, exits;
};

/* The names that there are, for who wrote another: the first twelve. {"", 0} at first. */
struct name_list {
    const char *text;
    int count;
};

void dag_list_name(struct dag *dag, struct name_list *list, const char *name);
void dag_note_names(struct dag *dag, const char *what, const struct name_list *list);

void dag_resolve_expression(struct dag *dag, const struct scope *scope, int expression);
void dag_resolve_answers(struct dag *dag, struct span answers, const char *what);
void dag_resolve_twice(struct dag *dag, const char *what, const char *name, struct where where,
                       struct where first);
/* An error where the type has any unit. */
void dag_refuse_any_unit(struct dag *dag, int type, struct where where);
/* may they have roles? */
void dag_resolve_parameters(struct dag *dag, struct span span, int roles);

/* what a tool's answers allow; all tools' names are known (resolve_guards.c) */
void dag_resolve_guards(struct dag *dag, struct tool *tool);

#endif
