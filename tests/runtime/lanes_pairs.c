/* lanes_pairs.c - the bits of the form factors of many pairs, one number for each kind:
 * check_lanes.sh compiles it for vectors of several widths. Pairs are quads and triangles at random
 * and on a coarse grid, so that they touch, cross, share edges, are parallel and are nothing.
 * SPDX-License-Identifier: MIT */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "terms/form_factor.h"
#include "terms/form_factor_range.h"

static uint64_t state = 88172645463325252;

static double even(void)
{
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return (double)(state >> 11) * 0x1p-53;
}

/* A parallelogram, or half of one, its corner and sides at random or on the grid. */
static struct element make(uint64_t id, int vertices, int grid, double spread)
{
    struct element e;
    double corner[3], side[2][3], n[3], size;
    memset(&e, 0, sizeof e);
    e.id = id;
    e.vertices = (uint8_t)vertices;
    do {
        for (int k = 0; k < 3; k++) {
            corner[k] = spread * (grid ? floor(4 * even()) / 4 : even());
            for (int i = 0; i < 2; i++)
                side[i][k] = grid ? floor(3 * even()) - 1 : 2 * even() - 1;
        }
        cross3(n, side[0], side[1]);
        size = length3(n);
    } while (!(size > 0));
    for (int k = 0; k < 3; k++) {
        e.normal[k] = n[k] / size;
        e.vertex[0][k] = corner[k];
        e.vertex[1][k] = corner[k] + side[0][k];
        e.vertex[2][k] = corner[k] + side[1][k] + (vertices == 4 ? side[0][k] : 0);
        e.vertex[3][k] = corner[k] + side[1][k];
        for (int i = 0; i < vertices; i++)
            e.centre[k] += e.vertex[i][k] / vertices;
    }
    e.area = vertices == 4 ? size : size / 2;
    for (int i = 0; i < vertices; i++) {
        double d[3];
        sub3(d, e.vertex[i], e.centre);
        e.radius = fmax(e.radius, length3(d));
    }
    return e;
}

static void mix(uint64_t *hash, double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    *hash = (*hash ^ bits) * 0x9e3779b97f4a7c15;
    *hash ^= *hash >> 29;
}

int main(void)
{
    uint64_t fair = 0, exact = 0, point = 0, range = 0;
    int some = 0;
    for (uint64_t i = 0; i < 6000; i++) {
        double spread = i % 5 == 0 ? 60 : i % 5 == 1 ? 8 : 2, seen[2];
        struct element a = make(2 * i, 3 + (int)(i % 2), i % 3 == 0, spread),
                       b = make(2 * i + 1, 3 + (int)(i / 2 % 2), i % 3 == 0, spread);
        double f = polygon_factor(&a, &b, 0);
        mix(&fair, f);
        mix(&exact, polygon_factor(&a, &b, 1));
        mix(&point, point_factor(&a, &b));
        form_factor_range_sample(&a, &b, seen);
        mix(&range, seen[0]);
        mix(&range, seen[1]);
        some += f > 0;
    }
    printf("%d pairs see each other: %016" PRIx64 " %016" PRIx64 " %016" PRIx64 " %016" PRIx64 "\n",
           some, fair, exact, point, range);
    return some > 500 ? 0 : 1;
}
