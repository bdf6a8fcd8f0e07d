/* make_tables.h - a room with three tables, with a ceiling or without.
 * SPDX-License-Identifier: MIT */
#ifndef MAKE_TABLES_H
#define MAKE_TABLES_H

#include <math.h>
#include "runtime/chance.h"
#include "runtime/make_polygons.h"

enum { TABLES = 3, CELLS = 4, FLOOR = CELLS * CELLS, WALLS = 6 * FLOOR };
enum { OFF = 12 };                  /* the room that has a row which does not add up at first */
enum { TABLE = 22, UNDERSIDE = 4 }; /* faces of a table; the board's lower side, where legs stand */

/* A rectangle's cells. */
static inline void wall(const double at[3], const double u[3], const double v[3])
{
    double cu[3], cv[3];
    for (int k = 0; k < 3; k++) {
        cu[k] = u[k] / CELLS;
        cv[k] = v[k] / CELLS;
    }
    for (int i = 0; i < CELLS * CELLS; i++) {
        double from[3];
        for (int k = 0; k < 3; k++)
            from[k] = at[k] + i % CELLS * cu[k] + i / CELLS * cv[k];
        rectangle(from, cu, cv);
    }
}

static inline void room(const double size[3], int open)
{
    static const double o[3] = {0, 0, 0};
    const double x[3] = {size[0], 0, 0}, y[3] = {0, size[1], 0}, z[3] = {0, 0, size[2]};
    wall(o, x, y);
    if (!open)
        wall(z, y, x);
    wall(o, z, x);
    wall(y, x, z);
    wall(o, y, z);
    wall(x, z, y);
}

/* A box from `low` to `high` over the floor about (x, y), turned; lids: 1, with top and bottom. */
static inline void box(const double middle[2], const double half[2], double turn, double low,
                       double high, int lids)
{
    const double c = cos(turn), s = sin(turn);
    double p[4][2];
    for (int i = 0; i < 4; i++) {
        const double u = (i == 1 || i == 2 ? 1 : -1) * half[0], v = (i >= 2 ? 1 : -1) * half[1];
        p[i][0] = middle[0] + c * u - s * v;
        p[i][1] = middle[1] + s * u + c * v;
    }
    for (int i = 0; i < 4; i++) {
        const double *a = p[i], *b = p[(i + 1) % 4];
        const double at[3] = {a[0], a[1], low}, u[3] = {b[0] - a[0], b[1] - a[1], 0},
                     v[3] = {0, 0, high - low};
        rectangle(at, u, v);
    }
    for (int top = 0; top < 2 && lids; top++) {
        const double at[3] = {p[0][0], p[0][1], top ? high : low},
                     u[3] = {p[1][0] - p[0][0], p[1][1] - p[0][1], 0},
                     v[3] = {p[3][0] - p[0][0], p[3][1] - p[0][1], 0};
        rectangle(at, top ? u : v, top ? v : u);
    }
}

static inline void table(const double at[2], const double half[2], double turn, double tall)
{
    const double leg[2] = {0.03, 0.03}, thick = 0.05;
    box(at, half, turn, tall - thick, tall, 1);
    for (int i = 0; i < 4; i++) {
        const double u = (i % 2 ? 1 : -1) * (half[0] - 0.06),
                     v = (i / 2 ? 1 : -1) * (half[1] - 0.06),
                     foot[2] = {at[0] + cos(turn) * u - sin(turn) * v,
                                at[1] + sin(turn) * u + cos(turn) * v};
        box(foot, leg, turn, 0, tall - thick, 0);
    }
}

/* Tables beside each other, each in its own third of the room. */
static inline void furnish(uint64_t seed, int open)
{
    uint64_t state = seed << 32;
    const double size[3] = {5 + 2 * chance(&state), 3 + 2 * chance(&state), 2.5};
    clear();
    room(size, open);
    for (int i = 0; i < TABLES; i++) {
        const double at[2] = {size[0] * (i + 0.5) / TABLES, size[1] * (0.3 + 0.4 * chance(&state))},
                     half[2] = {0.2 + 0.3 * chance(&state), 0.15 + 0.3 * chance(&state)};
        table(at, half, 3 * chance(&state), 0.4 + 0.5 * chance(&state));
    }
}

#endif
