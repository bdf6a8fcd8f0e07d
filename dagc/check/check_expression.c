/* check_expression.c - units, wholeness and bounds of computed values.
 *
 * Units follow dimensional algebra; numbers alone have whatever unit they are used with, so that
 * `max(area, 1e-4)` needs no suffix. Bounds are intervals (interval.c): an argument that passes
 * cannot leave its tool's range in any run. What is surely no number is an error here; what may be
 * none, as p / q, is looked at when it is computed (emit/emit_expression.c).
 * SPDX-License-Identifier: MIT */
#include <math.h>

#include "check/interval.h"

static const char *described(struct dag *dag, int expression)
{
    struct expression *e = &dag->expressions[expression];
    return dag_format(&dag->arena, "'%s' (%s)", dag_expression_text(dag, expression),
                      dag_unit_text(dag, &e->unit));
}

/* Both sides of + - min max have one unit. */
static int same_unit(struct dag *dag, struct expression *e, const char *verb)
{
    struct expression *a = &dag->expressions[e->left], *b = &dag->expressions[e->right];
    if (a->any_unit && !b->any_unit)
        a->unit = b->unit;
    if (b->any_unit && !a->any_unit)
        b->unit = a->unit;
    e->unit = a->unit;
    e->any_unit = a->any_unit && b->any_unit;
    if (dag_same_unit(&a->unit, &b->unit))
        return 1;
    if (e->kind == EXPRESSION_SUBTRACT)
        dag_error(dag, e->where, "cannot subtract %s from %s", described(dag, e->right),
                  described(dag, e->left));
    else
        dag_error(dag, e->where, "cannot %s %s and %s", verb, described(dag, e->left),
                  described(dag, e->right));
    dag_note(dag, dag_nowhere, "both must have the same unit");
    return 0;
}

static int check_leaf(struct dag *dag, struct expression *e)
{
    int type = -1;
    if (e->kind == EXPRESSION_NUMBER) {
        e->any_unit = 1;
        e->whole = e->number == floor(e->number) && isfinite(e->number);
        return 1;
    }
    if (e->kind == EXPRESSION_PARAMETER) {
        if (dag->parameters[e->parameter].bad)
            return 0;
        type = dag->parameters[e->parameter].type;
    } else if (e->kind == EXPRESSION_FACT)
        type = dag->facts[e->index].type;
    else if (e->kind == EXPRESSION_TERM)
        type = dag->terms[e->index].type;
    else if (e->kind == EXPRESSION_EXTERN)
        type = dag->callbacks[e->index].type;
    if (type < 0)
        return 0;
    e->unit = dag->types[type].unit;
    e->whole = dag->types[type].base == BASE_INTEGER;
    return 1;
}

static int check_root(struct dag *dag, struct expression *e)
{
    struct expression *a = &dag->expressions[e->left];
    e->unit = a->unit;
    e->any_unit = a->any_unit;
    e->whole = 0;
    if (!dag_unit_root(&e->unit)) {
        dag_error(dag, e->where, "%s has no root: an exponent of its unit is odd",
                  described(dag, e->left));
        return 0;
    }
    if (a->low < 0) {
        dag_error(dag, e->where, "'%s' may be negative, its root would be no number",
                  dag_expression_text(dag, e->left));
        dag_note(dag, dag_nowhere, "write: sqrt(max(%s, 0)), or give what it is made of a range",
                 dag_expression_text(dag, e->left));
        return 0;
    }
    return 1;
}

static int check_unary(struct dag *dag, struct expression *e)
{
    const struct expression *a = &dag->expressions[e->left];
    e->unit = a->unit;
    e->any_unit = a->any_unit;
    e->whole = a->whole;
    return e->kind != EXPRESSION_SQRT || check_root(dag, e);
}

static int check_binary(struct dag *dag, struct expression *e)
{
    const struct expression *a = &dag->expressions[e->left], *b = &dag->expressions[e->right];
    e->whole = a->whole && b->whole;
    switch (e->kind) {
    case EXPRESSION_ADD:
        return same_unit(dag, e, "add");
    case EXPRESSION_SUBTRACT:
        return same_unit(dag, e, "subtract");
    case EXPRESSION_MIN:
    case EXPRESSION_MAX:
        return same_unit(dag, e, "compare");
    default:
        break;
    }
    int sign = e->kind == EXPRESSION_MULTIPLY ? 1 : -1;
    e->any_unit = a->any_unit && b->any_unit;
    if (!dag_unit_product(&e->unit, &a->unit, &b->unit, sign)) {
        dag_error(dag, e->where, "the unit of '%s' has an exponent that is too large",
                  dag_expression_text(dag, (int)(e - dag->expressions)));
        return 0;
    }
    if (sign > 0)
        return 1;
    e->whole = 0;
    if (b->low == 0 && b->high == 0) {
        dag_error(dag, e->where, "a division by 0");
        return 0;
    }
    return 1;
}

static struct interval interval_of(const struct expression *e)
{
    struct interval r = {e->low, e->high, (enum none)e->none};
    return r;
}

/* The bounds of e from those of its operands; is it a number? */
static int check_bounds(struct dag *dag, struct expression *e)
{
    static const struct interval zero = {0, 0, NONE_NEVER};
    struct interval r =
        e->left < 0
            ? interval_leaf(dag, e, INTERVAL_RANGES)
            : interval_operate(e->kind, interval_of(&dag->expressions[e->left]),
                               e->right < 0 ? zero : interval_of(&dag->expressions[e->right]));
    e->low = r.low;
    e->high = r.high;
    e->none = (unsigned char)r.none;
    if (r.none != NONE_ALWAYS)
        return 1;
    dag_error(dag, e->where, "'%s' is no number, whatever else is",
              dag_expression_text(dag, (int)(e - dag->expressions)));
    dag_note(dag, dag_nowhere, "no numbers are: 0 * inf, inf - inf, inf / inf and 0 / 0");
    return 0;
}

int dag_check_expression(struct dag *dag, int expression)
{
    struct expression *e = &dag->expressions[expression];
    if (e->bad || e->checked)
        return !e->bad;
    int left = e->left < 0 || dag_check_expression(dag, e->left);
    int right = e->right < 0 || dag_check_expression(dag, e->right);
    int ok = left && right;
    if (ok)
        ok = e->left < 0    ? check_leaf(dag, e)
             : e->right < 0 ? check_unary(dag, e)
                            : check_binary(dag, e);
    ok = ok && check_bounds(dag, e);
    e->checked = 1;
    e->bad = !ok;
    return ok;
}
