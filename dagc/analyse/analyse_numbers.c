/* analyse_numbers.c - arguments that are no number.
 *
 * With branches in place and parameters as they are when nobody sets them more is known than when
 * an expression was checked as written: a branch's p / q may be 0 / 0 in one of its uses, and
 * share * most be 0 * inf by their defaults. What remains open is looked at when it is computed, by
 * the flat release and by the interpreter, which say the same: dag_doubt.
 * SPDX-License-Identifier: MIT */
#include "analyse/analyse.h"

#include <limits.h>
#include <math.h>
#include <string.h>

#include "check/interval.h"

/* characters of an expression in a sentence that a C compiler must take as one string */
enum { TEXT_MOST = 200 };

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

int dag_is_doubtful(const struct dag *dag, const struct argument *argument)
{
    const struct interval value = dag_interval(dag, argument->expression, INTERVAL_RANGES);
    return value.none != NONE_NEVER;
}

struct dag_doubt dag_doubt(struct dag *dag, const struct node *node,
                           const struct argument *argument)
{
    const struct parameter *parameter = &dag->parameters[argument->parameter];
    const char *text = dag_value_text(dag, argument->expression);
    struct dag_doubt doubt = {parameter->low, parameter->high, 0, NULL};
    char low[32], high[32];
    if (dag->types[parameter->type].base == BASE_INTEGER) { /* what a C int can hold */
        doubt.low = fmax(doubt.low, INT_MIN);
        doubt.high = fmin(doubt.high, INT_MAX);
    }
    doubt.instead = doubt.low > 0 ? doubt.low : doubt.high < 0 ? doubt.high : 0;
    doubt.what = dag_format(&dag->arena, "'%s' of node '%s' is no number from %s to %s: %.*s%s",
                            parameter->name, node->name, dag_number(doubt.low, low),
                            dag_number(doubt.high, high), TEXT_MOST, text,
                            strlen(text) > TEXT_MOST ? "..." : "");
    return doubt;
}
