/* analyse_numbers.c - arguments that are no number.
 *
 * With branches in place and parameters as they are when nobody sets them more is known than when
 * an expression was checked as written: a branch's p / q may be 0 / 0 in one of its uses, and
 * share * most be 0 * inf by their defaults.
 * SPDX-License-Identifier: MIT */
#include "analyse/analyse.h"
#include "check/interval.h"

static void check_argument(struct dag *dag, const struct node *node, int place)
{
    const struct argument *argument = &dag->arguments[node->arguments.first + place];
    const char *name = dag->parameters[argument->parameter].name;
    int always = dag_interval(dag, argument->expression, INTERVAL_RANGES).none == NONE_ALWAYS;
    if (!always && dag_interval(dag, argument->expression, INTERVAL_DEFAULTS).none != NONE_ALWAYS)
        return;
    if (dag_warn(dag, WARNING_NOT_A_NUMBER, argument->where, "'%s' of '%s' is no number%s", name,
                 node->name, always ? "" : ", unless the parameters it is made of are set"))
        dag_note(dag, dag_nowhere, "it is %s: 0 * inf, inf - inf, inf / inf or 0 / 0",
                 dag_value_text(dag, argument->expression));
}

void dag_analyse_numbers(struct dag *dag)
{
    for (int i = 0; i < dag->order_count; i++) {
        const struct node *node = &dag->nodes[dag->order[i]];
        dag->use = node->use;
        for (int a = 0; a < node->arguments.count; a++)
            check_argument(dag, node, a);
    }
}
