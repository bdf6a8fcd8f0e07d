/* check_expression.c - units, wholeness and bounds of computed values.
 *
 * Units follow dimensional algebra; numbers alone have whatever unit they are used with, so that
 * `max(area, 1e-4)` needs no suffix. Bounds are intervals: every operation here is monotone in
 * the doubles too, so a bound computed with the same operations holds to the last bit, and an
 * argument that passes cannot leave its tool's range in any run (a NaN apart: inf - inf).
 * SPDX-License-Identifier: MIT */
#include <math.h>

#include "base/internal.h"

static double smaller(double a, double b)
{
    return a < b ? a : b;
}

static double larger(double a, double b)
{
    return a > b ? a : b;
}

/* 0 * inf is 0 here: the bound of 0 * x for every finite x. */
static double product(double a, double b)
{
    return a == 0 || b == 0 ? 0 : a * b;
}

static void bounds_of_product(struct expression *e, const struct expression *a,
                              const struct expression *b)
{
    double p[4] = {product(a->low, b->low), product(a->low, b->high), product(a->high, b->low),
                   product(a->high, b->high)};
    e->low = smaller(smaller(p[0], p[1]), smaller(p[2], p[3]));
    e->high = larger(larger(p[0], p[1]), larger(p[2], p[3]));
}

/* By a divisor that may come near 0 from one side, the quotient may be anything of its sign. */
static void bounds_of_quotient(struct expression *e, const struct expression *a,
                               const struct expression *b)
{
    struct expression inverse = {0};
    inverse.low = -INFINITY;
    inverse.high = INFINITY;
    if (b->low >= 0) {
        inverse.low = 1 / b->high;
        inverse.high = b->low > 0 ? 1 / b->low : INFINITY;
    } else if (b->high <= 0) {
        inverse.low = b->high < 0 ? 1 / b->high : -INFINITY;
        inverse.high = 1 / b->low;
    }
    /* a / b and a * (1 / b) differ by rounding: only signs and infinities are certain, and the
     * quotients of the ends where none of them is 0 or infinite. */
    bounds_of_product(e, a, &inverse);
    if (isfinite(a->low) && isfinite(a->high) && isfinite(b->low) && isfinite(b->high)
        && (b->low > 0 || b->high < 0)) {
        double q[4] = {a->low / b->low, a->low / b->high, a->high / b->low, a->high / b->high};
        e->low = smaller(smaller(q[0], q[1]), smaller(q[2], q[3]));
        e->high = larger(larger(q[0], q[1]), larger(q[2], q[3]));
    } else {
        e->low = e->low < 0 ? -INFINITY : 0;
        e->high = e->high > 0 ? INFINITY : 0;
    }
}

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
        e->low = e->high = e->number;
        e->any_unit = 1;
        e->whole = e->number == floor(e->number) && isfinite(e->number);
        return 1;
    }
    if (e->kind == EXPRESSION_PARAMETER) {
        const struct parameter *parameter = &dag->parameters[e->parameter];
        if (parameter->bad)
            return 0;
        type = parameter->type;
        e->low = parameter->low;
        e->high = parameter->high;
    } else if (e->kind == EXPRESSION_FACT) {
        type = dag->facts[e->index].type;
        e->low = dag->facts[e->index].low;
        e->high = dag->facts[e->index].high;
    } else if (e->kind == EXPRESSION_TERM) {
        type = dag->terms[e->index].type;
        e->low = dag->terms[e->index].low;
        e->high = dag->terms[e->index].high;
    } else if (e->kind == EXPRESSION_EXTERN) {
        type = dag->callbacks[e->index].type;
        e->low = dag->callbacks[e->index].low;
        e->high = dag->callbacks[e->index].high;
    }
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
    e->low = sqrt(a->low);
    e->high = sqrt(a->high);
    return 1;
}

static int check_unary(struct dag *dag, struct expression *e)
{
    const struct expression *a = &dag->expressions[e->left];
    e->unit = a->unit;
    e->any_unit = a->any_unit;
    e->whole = a->whole;
    if (e->kind == EXPRESSION_SQRT)
        return check_root(dag, e);
    if (e->kind == EXPRESSION_NEGATE) {
        e->low = -a->high;
        e->high = -a->low;
    } else {
        e->low = a->low > 0 ? a->low : a->high < 0 ? -a->high : 0;
        e->high = larger(fabs(a->low), fabs(a->high));
    }
    return 1;
}

/* inf - inf as a bound stands for "no bound". */
static double bound(double value, double otherwise)
{
    return isnan(value) ? otherwise : value;
}

static int check_binary(struct dag *dag, struct expression *e)
{
    const struct expression *a = &dag->expressions[e->left], *b = &dag->expressions[e->right];
    e->whole = a->whole && b->whole;
    switch (e->kind) {
    case EXPRESSION_ADD:
        e->low = bound(a->low + b->low, -INFINITY);
        e->high = bound(a->high + b->high, INFINITY);
        return same_unit(dag, e, "add");
    case EXPRESSION_SUBTRACT:
        e->low = bound(a->low - b->high, -INFINITY);
        e->high = bound(a->high - b->low, INFINITY);
        return same_unit(dag, e, "subtract");
    case EXPRESSION_MIN:
        e->low = smaller(a->low, b->low);
        e->high = smaller(a->high, b->high);
        return same_unit(dag, e, "compare");
    case EXPRESSION_MAX:
        e->low = larger(a->low, b->low);
        e->high = larger(a->high, b->high);
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
    if (sign > 0) {
        bounds_of_product(e, a, b);
        return 1;
    }
    e->whole = 0;
    bounds_of_quotient(e, a, b);
    if (b->low == 0 && b->high == 0) {
        dag_error(dag, e->where, "a division by 0");
        return 0;
    }
    return 1;
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
    e->checked = 1;
    e->bad = !ok;
    return ok;
}
