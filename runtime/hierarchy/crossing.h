/* crossing.h - polygons whose outline crosses itself, as convex parts of what it goes round.
 * SPDX-License-Identifier: MIT */
#ifndef CROSSING_H
#define CROSSING_H

#include <stddef.h>
#include <stdint.h>

/* A trapezoid or a triangle, counter-clockwise about the normal. */
struct round_part {
    double vertex[4][3];
    uint32_t n;
};

struct round_parts {
    struct round_part *parts; /* [count] */
    size_t count, capacity;
};

/* A normal for a polygon whose parts cancel out: of the largest triangle of its first corner with
 * two neighbours. Returns that triangle's area (m2). */
double crossing_normal(double (*vertex)[3], uint32_t count, double normal[3]);

/* Make `parts` hold all that the outline goes round, once: where it goes round to the left more or
 * less often than to the right, seen along the unit normal (the rule "nonzero" of fill). Returns 0,
 * or -1 when out of memory. */
int crossing_parts(struct round_parts *parts, double (*vertex)[3], uint32_t count,
                   const double normal[3]);

#endif
