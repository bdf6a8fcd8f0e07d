/* rows.h - rows of four numbers that stand in four places become columns, which loops go over
 * several at a time (lanes.h): by whole vectors, since what is written number by number and read as
 * one vector at once makes a processor wait. Without vectors, or in a compiler that cannot shuffle
 * them, number by number: the same numbers.
 * SPDX-License-Identifier: MIT */
#ifndef KERNEL_ROWS_H
#define KERNEL_ROWS_H

#include <string.h>
#include "discussion.h"
#include "kernel/lanes.h"

#if LANES_CHOSEN && defined __has_builtin
#if __has_builtin(__builtin_shufflevector)
#define ROWS_VECTORS 1
typedef double rows_row __attribute__((vector_size(32), aligned(8), may_alias));
#endif
#endif
#ifdef ROWS_VECTORS
#define ROWS_ROW(from) (*(const rows_row *)(const void *)((const char *)(from) + offset))
/* column[c][k]: number c of the row that stands at an offset in p, q, r, s, by k. */
TOOL void rows_turn(const void *p, const void *q, const void *r, const void *s, size_t offset,
                    double column[4][4])
{
    const rows_row a = ROWS_ROW(p), b = ROWS_ROW(q), c = ROWS_ROW(r), d = ROWS_ROW(s),
                   e = __builtin_shufflevector(a, b, 0, 4, 2, 6),
                   f = __builtin_shufflevector(a, b, 1, 5, 3, 7),
                   g = __builtin_shufflevector(c, d, 0, 4, 2, 6),
                   h = __builtin_shufflevector(c, d, 1, 5, 3, 7);
    *(rows_row *)column[0] = __builtin_shufflevector(e, g, 0, 1, 4, 5);
    *(rows_row *)column[1] = __builtin_shufflevector(f, h, 0, 1, 4, 5);
    *(rows_row *)column[2] = __builtin_shufflevector(e, g, 2, 3, 6, 7);
    *(rows_row *)column[3] = __builtin_shufflevector(f, h, 2, 3, 6, 7);
}

TOOL void rows_four(double to[4], double a, double b, double c, double d)
{
    const rows_row row = {a, b, c, d};
    *(rows_row *)to = row;
}
#else
TOOL void rows_turn(const void *p, const void *q, const void *r, const void *s, size_t offset,
                    double column[4][4])
{
    const void *const from[4] = {p, q, r, s};
    double row[4];
    for (int k = 0; k < 4; k++) {
        memcpy(row, (const char *)from[k] + offset, sizeof row);
        for (int c = 0; c < 4; c++)
            column[c][k] = row[c];
    }
}

TOOL void rows_four(double to[4], double a, double b, double c, double d)
{
    to[0] = a;
    to[1] = b;
    to[2] = c;
    to[3] = d;
}
#endif

#endif
