/* lanes_pairs.c - the bits of the form factors of many pairs, of points that visibility is sampled
 * between, and of the shafts between them, one number for each kind: check_lanes.sh compiles it for
 * vectors of several widths. Pairs, and the faces and boxes that shafts are asked for, are quads
 * and triangles at random and on a coarse grid, so that they touch, cross, share edges, are
 * parallel and are nothing.
 * SPDX-License-Identifier: MIT */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "even_numbers.h"
#include "terms/form_factor.h"
#include "terms/form_factor_range.h"
#include "terms/blockers.h"
#include "terms/visibility.h"

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

/* Of shafts: how many there are, faces that meet one, for which a segment proves it, that cover it,
 * and boxes that it misses. */
static int shafts, met, pierced, covered, missed;

/* The planes, and what they say of a face and of its box. */
static void mix_shaft(uint64_t *hash, const struct element *a, const struct element *b,
                      const struct element *face, const struct host *host)
{
    struct shaft shaft;
    struct cut inside;
    double low[3], high[3];
    if (!shaft_open(&shaft, a, b, host))
        return;
    shafts++;
    for (int i = 0; i < shaft.planes; i++) {
        for (int k = 0; k < 3; k++)
            mix(hash, shaft.normal[k][i]);
        mix(hash, shaft.offset[i]);
    }
    const double(*v)[3] = (const double(*)[3])face->vertex;
    inside.n = 0;
    met += shaft_meets(&shaft, v, face->vertices, &inside);
    double normal[3];
    pierced +=
        shaft_normal(v, face->vertices, normal) && shaft_pierced(&shaft, v, face->vertices, normal);
    for (int i = 0; i < inside.n; i++)
        for (int k = 0; k < 3; k++)
            mix(hash, inside.v[i][k]);
    covered += shaft_covered(&shaft, v, face->vertices);
    for (int k = 0; k < 3; k++) {
        low[k] = face->centre[k] - 0.2 * face->radius;
        high[k] = face->centre[k] + 0.2 * face->radius;
    }
    missed += shaft_misses_box(&shaft, low, high);
    mix(hash, met + 0.5 * covered + 0.25 * missed + 0.125 * pierced);
}

/* What lies below z = .5 is hidden: where segments go shows in the answer. */
static uint64_t below(const struct host *host, int count, const struct segment *segments)
{
    uint64_t hits = 0;
    (void)host;
    for (int i = 0; i < count; i++)
        hits |= (uint64_t)(segments[i].from[2] < 0.5 || segments[i].to[2] < 0.5) << i;
    return hits;
}

int main(void)
{
    struct host host;
    memset(&host, 0, sizeof host);
    host.occluded = below;
    uint64_t shaft = 0, seen_by_rays = 0, fair = 0, exact = 0, point = 0, range = 0;
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
        const struct element face = make(i, 3 + (int)(i / 4 % 2), i % 3 == 0, spread / 2);
        host.ray_offset = 1e-5 * spread;
        mix_shaft(&shaft, &a, &b, &face, &host);
        mix(&seen_by_rays, visibility_rays(&a, &b, &host, i % 2 ? 16 : 64, 0));
    }
    printf("%d pairs see each other: %016" PRIx64 " %016" PRIx64 " %016" PRIx64 " %016" PRIx64
           " %016" PRIx64 "\n",
           some, fair, exact, point, range, seen_by_rays);
    printf("%d shafts: %d faces meet one, %d cover it, %d boxes are outside: %016" PRIx64 "\n",
           shafts, met, covered, missed, shaft);
    const int least = 100; /* of each, else the pairs try nothing */
    return some > least && met > least && met < shafts - least && missed > least
                   && missed < shafts - least
               ? 0
               : 1;
}
