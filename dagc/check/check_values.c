/* check_values.c - is every number of the kind, the unit and in the range that it must be?
 *
 * A bare number fits any type; a parameter must have the unit of what it is given for, and its
 * range must lie inside: then no value it is ever set to can leave the tool's range, and nothing
 * is left to check at run time.
 * SPDX-License-Identifier: MIT */
#include <limits.h>

#include "base/internal.h"

static int is_integer(double value)
{
    return value >= INT_MIN && value <= INT_MAX && value == (double)(int)value;
}

/* "[0, inf]" */
static const char *range(struct dag *dag, double low, double high)
{
    char a[32], b[32];
    return dag_format(&dag->arena, "[%s, %s]", dag_number(low, a), dag_number(high, b));
}

/* Default and range of one parameter, of a tool or of an oracle. */
static void check_parameter(struct dag *dag, struct parameter *parameter)
{
    if (parameter->bad || parameter->type < 0) /* no type: the tool was lost to a syntax error */
        return;
    int integer = dag->types[parameter->type].base == BASE_INTEGER;
    if (parameter->low > parameter->high) {
        dag_error(dag, parameter->range_where, "the range %s holds no number",
                  range(dag, parameter->low, parameter->high));
        parameter->bad = 1;
        return;
    }
    if ((parameter->given & PARAMETER_VALUE) == 0)
        return;
    char text[32];
    if (integer && !is_integer(parameter->value)) {
        dag_error(dag, parameter->value_where,
                  "'%s' is a whole number that a C int can hold, %s is none", parameter->name,
                  dag_number(parameter->value, text));
        dag_note(dag, parameter->type_where, "its type is '%s'", parameter->type_name);
        parameter->bad = 1;
    } else if (!(parameter->value >= parameter->low && parameter->value <= parameter->high)) {
        dag_error(dag, parameter->value_where, "the default %s of '%s' is not in its range %s",
                  dag_number(parameter->value, text), parameter->name,
                  range(dag, parameter->low, parameter->high));
        parameter->bad = 1;
    }
}

static void check_number(struct dag *dag, const struct expression *expression,
                         const struct parameter *wanted, const char *tool)
{
    char text[32];
    if (dag->types[wanted->type].base == BASE_INTEGER && !is_integer(expression->number)) {
        dag_error(dag, expression->where,
                  "'%s' of %s is a whole number that a C int can hold, %s is none", wanted->name,
                  tool, dag_number(expression->number, text));
        dag_note(dag, wanted->where, "declared here, of type '%s'", wanted->type_name);
    } else if (!(expression->number >= wanted->low && expression->number <= wanted->high)) {
        dag_error(dag, expression->where, "%s is out of range: '%s' of %s takes %s",
                  dag_number(expression->number, text), wanted->name, tool,
                  range(dag, wanted->low, wanted->high));
        dag_note(dag, wanted->where, "declared here");
    }
}

static void check_reference(struct dag *dag, const struct expression *expression,
                            const struct parameter *wanted, const char *tool)
{
    const struct parameter *given = &dag->parameters[expression->parameter];
    if (given->bad)
        return;
    const struct type *from = &dag->types[given->type], *to = &dag->types[wanted->type];
    if (!to->any_unit && !dag_same_unit(&from->unit, &to->unit)) {
        dag_error(dag, expression->where, "'%s' of %s is of type %s (%s), but '%s' is %s (%s)",
                  wanted->name, tool, to->name, dag_unit_name(to), given->name, from->name,
                  dag_unit_name(from));
        dag_note(dag, given->where, "'%s' is declared here", given->name);
    } else if (to->base == BASE_INTEGER && from->base != BASE_INTEGER) {
        dag_error(dag, expression->where, "'%s' of %s is a whole number (%s), but '%s' is %s",
                  wanted->name, tool, to->name, given->name, from->name);
        dag_note(dag, given->where, "'%s' is declared here", given->name);
    } else if (!(given->low >= wanted->low && given->high <= wanted->high)) {
        dag_error(dag, expression->where,
                  "the argument may leave its range: '%s' lies in %s, '%s' of %s takes %s",
                  given->name, range(dag, given->low, given->high), wanted->name, tool,
                  range(dag, wanted->low, wanted->high));
        double low = given->low > wanted->low ? given->low : wanted->low;
        double high = given->high < wanted->high ? given->high : wanted->high;
        if (low <= high)
            dag_note(dag, given->where, "narrow it here: in %s", range(dag, low, high));
    }
}

static void check_computed(struct dag *dag, const struct expression *e,
                           const struct parameter *wanted, const char *tool)
{
    const struct type *to = &dag->types[wanted->type];
    const char *text = dag_expression_text(dag, (int)(e - dag->expressions));
    if (!to->any_unit && !e->any_unit && !dag_same_unit(&e->unit, &to->unit)) {
        dag_error(dag, e->where, "'%s' of %s is of type %s (%s), but '%s' is %s", wanted->name,
                  tool, to->name, dag_unit_name(to), text, dag_unit_text(dag, &e->unit));
        dag_note(dag, wanted->where, "declared here");
    } else if (to->base == BASE_INTEGER && !e->whole) {
        dag_error(dag, e->where, "'%s' of %s is a whole number (%s), but '%s' may be none",
                  wanted->name, tool, to->name, text);
        dag_note(dag, dag_nowhere, "whole are: whole numbers, and + - * min max abs of them");
    } else {
        double low = wanted->low, high = wanted->high;
        if (to->base == BASE_INTEGER) { /* what a C int can hold */
            low = low < INT_MIN ? INT_MIN : low;
            high = high > INT_MAX ? INT_MAX : high;
        }
        if (e->low >= low && e->high <= high)
            return;
        dag_error(dag, e->where,
                  "the argument may leave its range: '%s' lies in %s, '%s' of %s takes %s", text,
                  range(dag, e->low, e->high), wanted->name, tool, range(dag, low, high));
        char a[32], b[32];
        if (e->low < low && e->high > high)
            dag_note(dag, dag_nowhere, "write: min(max(%s, %s), %s)", text, dag_number(low, a),
                     dag_number(high, b));
        else
            dag_note(dag, dag_nowhere, "write: %s(%s, %s)", e->low < low ? "max" : "min", text,
                     dag_number(e->low < low ? low : high, a));
    }
}

static void check_argument(struct dag *dag, const struct argument *argument, const char *tool)
{
    const struct parameter *wanted = &dag->parameters[argument->parameter];
    struct expression *expression = &dag->expressions[argument->expression];
    if (wanted->bad || !dag_check_expression(dag, argument->expression))
        return;
    if (expression->kind == EXPRESSION_NUMBER)
        check_number(dag, expression, wanted, tool);
    else if (expression->kind == EXPRESSION_PARAMETER)
        check_reference(dag, expression, wanted, tool);
    else
        check_computed(dag, expression, wanted, tool);
    if (expression->any_unit && !dag->types[wanted->type].any_unit)
        expression->unit = dag->types[wanted->type].unit;
}

/* What a tool takes in any unit, it takes in one: numbers alone have that of the others. */
static void check_any_units(struct dag *dag, const struct node *node, const char *tool)
{
    const struct argument *first = NULL;
    for (int i = node->arguments.first; i < node->arguments.first + node->arguments.count; i++) {
        const struct argument *a = &dag->arguments[i];
        const struct parameter *wanted = &dag->parameters[a->parameter];
        if (a->expression < 0 || wanted->bad || !dag->types[wanted->type].any_unit)
            continue;
        const struct expression *e = &dag->expressions[a->expression];
        if (e->bad || e->any_unit)
            continue;
        if (first == NULL)
            first = a;
        const struct expression *one = &dag->expressions[first->expression];
        if (dag_same_unit(&one->unit, &e->unit))
            continue;
        dag_error(dag, e->where, "'%s' of %s is %s, but '%s' is %s", wanted->name, tool,
                  dag_unit_text(dag, &e->unit), dag->parameters[first->parameter].name,
                  dag_unit_text(dag, &one->unit));
        dag_note(dag, dag_nowhere, "%s compares numbers of one unit, whichever it is", tool);
    }
}

static void check_graph(struct dag *dag, const struct oracle_graph *graph)
{
    dag->use = graph->use;
    for (int i = graph->drafts.first; i < graph->drafts.first + graph->drafts.count; i++) {
        const struct node *node = &dag->drafts[i];
        const char *callee = node->branch >= 0 ? dag->branches[node->branch].name
                             : node->tool >= 0 ? dag->tools[node->tool].name
                                               : "";
        for (int a = node->arguments.first; a < node->arguments.first + node->arguments.count; a++)
            if (dag->arguments[a].expression >= 0)
                check_argument(dag, &dag->arguments[a], callee);
        check_any_units(dag, node, callee);
    }
    dag->use = -1;
}

/* Branches are checked as they are written, with their own parameters' ranges: what fits there
 * fits wherever the branch is used. */
void dag_check_values(struct dag *dag)
{
    for (int i = 0; i < dag->parameter_count; i++)
        check_parameter(dag, &dag->parameters[i]);
    for (int i = 0; i < dag->oracle_count; i++)
        check_graph(dag, &dag->oracles[i]);
    for (int i = 0; i < dag->branch_count; i++)
        check_graph(dag, &dag->branches[i]);
}
