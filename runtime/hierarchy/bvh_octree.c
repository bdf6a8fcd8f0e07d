/* bvh_octree.c - clusters by a uniform octree.
 *
 * The scene's box, made a cube, is cut in eight, and so on. A face belongs to the octant that holds
 * its middle, and goes no deeper than cells of its own size; so cells overlap by half of their side
 * at the most, and no face climbs to the root only because it lies across a border, as it does
 * where cells must hold their faces whole. Faces too large for the octants become a cluster of
 * their own beside them, cut by the surface-area heuristic. A cell of LEAF faces or fewer is not
 * cut.
 * [cells with slack: Ulrich 2000; octrees among the strategies for clusters: Hasenfratz, Damez,
 * Sillion and Drettakis 1999]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>
#include "hierarchy/bvh_strategy.h"

enum { LEAF = PARTS_MAX, OCTANTS = 8, TOO_LARGE = OCTANTS, KINDS, HALVINGS = 256 };
enum { ROOT, CELL, BOXES }; /* part.at: what the part is */

static double extent(const struct item *x)
{
    double e = 0;
    for (int k = 0; k < 3; k++)
        e = fmax(e, x->box.high[k] - x->box.low[k]);
    return e;
}

static void cube(struct bounds *cell)
{
    double side = 0;
    for (int k = 0; k < 3; k++)
        side = fmax(side, cell->high[k] - cell->low[k]);
    for (int k = 0; k < 3; k++) {
        double middle = 0.5 * (cell->low[k] + cell->high[k]);
        cell->low[k] = middle - 0.5 * side;
        cell->high[k] = middle + 0.5 * side;
    }
}

static struct bounds octant_of(const struct bounds *cell, int octant)
{
    struct bounds o = *cell;
    for (int k = 0; k < 3; k++) {
        double middle = 0.5 * (cell->low[k] + cell->high[k]);
        if (octant >> k & 1)
            o.low[k] = middle;
        else
            o.high[k] = middle;
    }
    return o;
}

static int kind(const struct item *x, const void *context)
{
    const struct bounds *cell = context;
    int octant = 0;
    if (extent(x) > 0.5 * (cell->high[0] - cell->low[0]))
        return TOO_LARGE;
    for (int k = 0; k < 3; k++)
        octant |= (item_centre(x, k) >= 0.5 * (cell->low[k] + cell->high[k])) << k;
    return octant;
}

/* Two parts by boxes. */
static int cut(const struct build *b, const struct part *whole, struct part *parts, int threads)
{
    parts[0] = parts[1] = *whole;
    parts[0].to = parts[1].from = build_cut(b, whole->from, whole->to, threads);
    parts[0].at = parts[1].at = BOXES;
    return 2;
}

static int divide(const struct build *b, const struct part *whole, struct part *parts, int threads)
{
    struct bounds cell = whole->cell;
    uint32_t count[KINDS], from = whole->from;
    int n = 0;
    if (whole->at == BOXES)
        return cut(b, whole, parts, threads);
    if (whole->to - whole->from <= LEAF) {
        for (uint32_t i = whole->from; i < whole->to; i++)
            parts[n++] = (struct part){.from = i, .to = i + 1};
        return n;
    }
    if (whole->at == ROOT)
        cube(&cell);
    int k, halved;
    /* A cell with all its faces in one octant is that octant. */
    for (halved = 0; halved < HALVINGS; halved++) {
        build_sort(b, whole, KINDS, kind, &cell, count);
        for (k = 0; k < KINDS && count[k] < whole->to - whole->from; k++)
            continue;
        if (k == KINDS)
            break;
        if (k == TOO_LARGE)
            return cut(b, whole, parts, threads);
        cell = octant_of(&cell, k);
    }
    if (halved == HALVINGS)
        return cut(b, whole, parts, threads);
    int cells;
    for (cells = 0, k = 0; k < OCTANTS; k++)
        cells += count[k] > 0;
    /* Eight octants and those too large would be nine: the octants are then one part, which
     * comes back with none too large. */
    if (count[TOO_LARGE] && cells == OCTANTS) {
        parts[n++] = (struct part){from, whole->to - count[TOO_LARGE], CELL, cell};
        from = parts[0].to;
        memset(count, 0, OCTANTS * sizeof *count);
    }
    for (k = 0; k < KINDS; k++) {
        if (count[k])
            parts[n++] = (struct part){from, from + count[k], k == TOO_LARGE ? BOXES : CELL,
                                       k == TOO_LARGE ? cell : octant_of(&cell, k)};
        from += count[k];
    }
    return n;
}

const struct strategy build_octree = {NULL, divide, NULL};
