/* mesh.c - a room 4 x 3 x 2.5 m with a lamp and a table.
 * SPDX-License-Identifier: MIT */
#include <math.h>

#include "mesh.h"

const struct patch room[ROOM_PATCHES] = {
    {{0, 0, 0}, {{4, 0, 0}, {0, 3, 0}}, 40, 0, 1},   /* floor */
    {{0, 0, 2.5}, {{0, 3, 0}, {4, 0, 0}}, 60, 0, 2}, /* ceiling */
    {{0, 0, 0}, {{0, 3, 0}, {0, 0, 2.5}}, 50, 0, 3}, /* walls */
    {{4, 0, 0}, {{0, 0, 2.5}, {0, 3, 0}}, 50, 0, 4},
    {{0, 0, 0}, {{0, 0, 2.5}, {4, 0, 0}}, 50, 0, 5},
    {{0, 3, 0}, {{4, 0, 0}, {0, 0, 2.5}}, 50, 0, 6},
    {{1.5, 1, 2.4}, {{0, 1, 0}, {1, 0, 0}}, 2000, 0, 7},       /* lamp, downwards */
    {{1.25, 0.75, 0.8}, {{1.5, 0, 0}, {0, 1.2, 0}}, 80, 0, 8}, /* table, its top */
    {{1.25, 0.75, 0.8}, {{0, 1.2, 0}, {1.5, 0, 0}}, 5, 0, 9},  /* and its underside */
};

static void cross(double out[3], const double a[3], const double b[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

double patch_area(const struct patch *p)
{
    double n[3];
    cross(n, p->side[0], p->side[1]);
    return sqrt(dot(n, n));
}

void patch_normal(const struct patch *p, double normal[3])
{
    double size = patch_area(p);
    int k;
    cross(normal, p->side[0], p->side[1]);
    for (k = 0; k < 3; k++)
        normal[k] /= size;
}

void patch_corner(const struct patch *p, int corner, double at[3])
{
    int k;
    for (k = 0; k < 3; k++)
        at[k] = p->corner[k] + (corner == 1 || corner == 2 ? p->side[0][k] : 0)
                + (corner >= 2 ? p->side[1][k] : 0);
}

struct patch patch_quarter(const struct patch *p, int quarter)
{
    struct patch q = *p;
    int k;
    for (k = 0; k < 3; k++) {
        q.side[0][k] = 0.5 * p->side[0][k];
        q.side[1][k] = 0.5 * p->side[1][k];
        q.corner[k] += (quarter % 2 ? q.side[0][k] : 0) + (quarter / 2 ? q.side[1][k] : 0);
    }
    q.depth = p->depth + 1;
    q.number = 16 * p->number + (unsigned)quarter;
    return q;
}

int room_blocks(const double from[3], const double to[3])
{
    int i, k;
    for (i = 0; i < ROOM_PATCHES; i++) {
        const struct patch *p = &room[i];
        double n[3], w[3], along[3], down, t, u, v;
        cross(n, p->side[0], p->side[1]);
        for (k = 0; k < 3; k++) {
            along[k] = to[k] - from[k];
            w[k] = p->corner[k] - from[k];
        }
        down = dot(along, n);
        if (fabs(down) < 1e-12)
            continue;
        t = dot(w, n) / down;
        if (t <= 0 || t >= 1)
            continue;
        for (k = 0; k < 3; k++)
            w[k] = t * along[k] - w[k]; /* from the corner to where the plane is met */
        u = dot(w, p->side[0]) / dot(p->side[0], p->side[0]);
        v = dot(w, p->side[1]) / dot(p->side[1], p->side[1]);
        if (u >= 0 && u <= 1 && v >= 0 && v <= 1)
            return 1;
    }
    return 0;
}
