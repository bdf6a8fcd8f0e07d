/* interval.h - which numbers an expression may be (interval.c).
 * SPDX-License-Identifier: MIT */
#ifndef INTERVAL_H
#define INTERVAL_H

#include "base/internal.h"

/* Is the value no number, as 0 * inf; or, maybe, one beyond its bounds, as 1 / x where x may be -0?
 */
enum none { NONE_NEVER, NONE_MAYBE, NONE_ALWAYS };

struct interval {
    double low, high; /* of the numbers it may be; both may be infinite */
    enum none none;
};

/* With an oracle's parameters as a program may set them; those that are `fixed` as they are; all as
 * they are when nobody sets them. */
enum interval_of { INTERVAL_RANGES, INTERVAL_FIXED, INTERVAL_DEFAULTS };

struct interval interval_leaf(const struct dag *dag, const struct expression *e,
                              enum interval_of of);
/* An operator's value; b of one with a single operand is not looked at, but must be a number. */
struct interval interval_operate(enum expression_kind kind, struct interval a, struct interval b);

/* Of a whole tree, whose names are resolved. */
struct interval dag_interval(const struct dag *dag, int expression, enum interval_of of);

#endif
