/* interval.c - which numbers an expression may be: interval arithmetic.
 *
 * Every operation here is monotone in the doubles too, so a bound computed with the same operations
 * holds to the last bit. Beside the bounds stands whether the value may be none at all: 0 * inf,
 * inf - inf, 0 / 0 and inf / inf are no numbers, a range that reaches to inf holds inf, and what is
 * made of no number is none. Where both operands are one number each the answer is certain.
 * SPDX-License-Identifier: MIT */
#include "check/interval.h"

#include <math.h>

static double smaller(double a, double b)
{
    return a < b ? a : b;
}

static double larger(double a, double b)
{
    return a > b ? a : b;
}

static int holds_zero(struct interval a)
{
    return a.low <= 0 && a.high >= 0;
}

static int holds_infinity(struct interval a)
{
    return isinf(a.low) || isinf(a.high);
}

/* inf - inf as a bound stands for "no bound". */
static double bound(double value, double otherwise)
{
    return isnan(value) ? otherwise : value;
}

/* 0 * inf is 0 here: the bound of 0 * x for every finite x. */
static double product(double a, double b)
{
    return a == 0 || b == 0 ? 0 : a * b;
}

static struct interval times(struct interval a, struct interval b)
{
    double p[4] = {product(a.low, b.low), product(a.low, b.high), product(a.high, b.low),
                   product(a.high, b.high)};
    struct interval r = {smaller(smaller(p[0], p[1]), smaller(p[2], p[3])),
                         larger(larger(p[0], p[1]), larger(p[2], p[3])), NONE_NEVER};
    return r;
}

/* By a divisor that may come near 0 from one side, the quotient may be anything of its sign. */
static struct interval quotient(struct interval a, struct interval b)
{
    struct interval inverse = {-INFINITY, INFINITY, NONE_NEVER};
    if (b.low >= 0) {
        inverse.low = 1 / b.high;
        inverse.high = b.low > 0 ? 1 / b.low : INFINITY;
    } else if (b.high <= 0) {
        inverse.low = b.high < 0 ? 1 / b.high : -INFINITY;
        inverse.high = 1 / b.low;
    }
    /* a / b and a * (1 / b) differ by rounding: only signs and infinities are certain, and the
     * quotients of the ends where none of them is 0 or infinite. */
    struct interval r = times(a, inverse);
    if (isfinite(a.low) && isfinite(a.high) && isfinite(b.low) && isfinite(b.high)
        && (b.low > 0 || b.high < 0)) {
        double q[4] = {a.low / b.low, a.low / b.high, a.high / b.low, a.high / b.high};
        r.low = smaller(smaller(q[0], q[1]), smaller(q[2], q[3]));
        r.high = larger(larger(q[0], q[1]), larger(q[2], q[3]));
    } else {
        r.low = r.low < 0 ? -INFINITY : 0;
        r.high = r.high > 0 ? INFINITY : 0;
    }
    return r;
}

static struct interval operate(enum expression_kind kind, struct interval a, struct interval b)
{
    struct interval r = {-INFINITY, INFINITY, NONE_NEVER};
    switch (kind) {
    case EXPRESSION_NEGATE:
        r.low = -a.high;
        r.high = -a.low;
        break;
    case EXPRESSION_SQRT:
        r.low = sqrt(a.low);
        r.high = sqrt(a.high);
        break;
    case EXPRESSION_ABS:
        r.low = a.low > 0 ? a.low : a.high < 0 ? -a.high : 0;
        r.high = larger(fabs(a.low), fabs(a.high));
        break;
    case EXPRESSION_ADD:
        r.low = bound(a.low + b.low, -INFINITY);
        r.high = bound(a.high + b.high, INFINITY);
        break;
    case EXPRESSION_SUBTRACT:
        r.low = bound(a.low - b.high, -INFINITY);
        r.high = bound(a.high - b.low, INFINITY);
        break;
    case EXPRESSION_MULTIPLY:
        return times(a, b);
    case EXPRESSION_DIVIDE:
        return quotient(a, b);
    case EXPRESSION_MIN:
        r.low = smaller(a.low, b.low);
        r.high = smaller(a.high, b.high);
        break;
    case EXPRESSION_MAX:
        r.low = larger(a.low, b.low);
        r.high = larger(a.high, b.high);
        break;
    default:
        break;
    }
    return r;
}

/* May the operation make no number of two that are, or one beyond the bounds? */
static int may_be_none(enum expression_kind kind, struct interval a, struct interval b)
{
    switch (kind) {
    case EXPRESSION_ADD:
        return (a.high == INFINITY && b.low == -INFINITY)
               || (a.low == -INFINITY && b.high == INFINITY);
    case EXPRESSION_SUBTRACT:
        return (a.high == INFINITY && b.high == INFINITY)
               || (a.low == -INFINITY && b.low == -INFINITY);
    case EXPRESSION_MULTIPLY:
        return (holds_zero(a) && holds_infinity(b)) || (holds_infinity(a) && holds_zero(b));
    case EXPRESSION_DIVIDE:
        return holds_zero(b) || (holds_infinity(a) && holds_infinity(b));
    default:
        return 0;
    }
}

/* What the operations that may be none make of two numbers. */
static double one_of(enum expression_kind kind, double a, double b)
{
    return kind == EXPRESSION_ADD        ? a + b
           : kind == EXPRESSION_SUBTRACT ? a - b
           : kind == EXPRESSION_MULTIPLY ? a * b
                                         : a / b;
}

struct interval interval_operate(enum expression_kind kind, struct interval a, struct interval b)
{
    struct interval r = operate(kind, a, b);
    int certain = a.low == a.high && b.low == b.high;
    if (a.none == NONE_ALWAYS || b.none == NONE_ALWAYS)
        r.none = NONE_ALWAYS;
    else if (may_be_none(kind, a, b))
        r.none = certain && a.none == NONE_NEVER && b.none == NONE_NEVER
                         && isnan(one_of(kind, a.low, b.low))
                     ? NONE_ALWAYS
                     : NONE_MAYBE;
    else
        r.none = a.none || b.none ? NONE_MAYBE : NONE_NEVER;
    return r;
}

struct interval interval_leaf(const struct dag *dag, const struct expression *e,
                              enum interval_of of)
{
    struct interval r = {-INFINITY, INFINITY, NONE_NEVER};
    const struct parameter *parameter;
    switch (e->kind) {
    case EXPRESSION_NUMBER:
        r.low = r.high = e->number;
        break;
    case EXPRESSION_PARAMETER:
        parameter = &dag->parameters[e->parameter];
        r.low = parameter->low;
        r.high = parameter->high;
        if (parameter->given & PARAMETER_VALUE
            && (of == INTERVAL_DEFAULTS || (of == INTERVAL_FIXED && parameter->fixed)))
            r.low = r.high = parameter->value;
        break;
    case EXPRESSION_FACT:
        r.low = dag->facts[e->index].low;
        r.high = dag->facts[e->index].high;
        break;
    case EXPRESSION_TERM:
        r.low = dag->terms[e->index].low;
        r.high = dag->terms[e->index].high;
        break;
    case EXPRESSION_EXTERN: /* somebody's C: a number is what it ought to give */
        r.low = dag->callbacks[e->index].low;
        r.high = dag->callbacks[e->index].high;
        r.none = NONE_MAYBE;
        break;
    default:
        break;
    }
    return r;
}

struct interval dag_interval(const struct dag *dag, int expression, enum interval_of of)
{
    const struct expression *e = &dag->expressions[expression];
    static const struct interval zero = {0, 0, NONE_NEVER};
    if (e->left < 0)
        return interval_leaf(dag, e, of);
    struct interval a = dag_interval(dag, e->left, of);
    return interval_operate(e->kind, a, e->right < 0 ? zero : dag_interval(dag, e->right, of));
}
