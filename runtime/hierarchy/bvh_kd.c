/* bvh_kd.c - clusters by an overlapping k-d tree.
 *
 * A cell is cut where area times number, summed over its two sides, is least; the area is that of
 * the side, not of what is in it, and a face counts on each side that it reaches into [MacDonald
 * and Booth 1990]. A face belongs to the side of its middle; one that is longer across the plane
 * than that side is wide belongs to neither and stays at the node, so that a wall does not make a
 * cell of small things large [overlapping k-d trees as clusters: Hasenfratz, Damez, Sillion and
 * Drettakis 1999; this rule: derived here]. Those that stay become a cluster beside the sides.
 * Three cuts make a node, as in bvh_sah.c. A cell is never larger than the box of what is in it.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stddef.h>
#include "hierarchy/bvh_strategy.h"

enum { PLANES = 15 };
enum { CELL, BOXES }; /* part.at: what the part is */
enum { LEFT, RIGHT, STAYS, KINDS };

struct plane {
    struct bounds cell; /* that it cuts */
    int axis;
    double at;
};

/* Slice of the centres' range in which p lies, 0 .. PLANES. */
static int slice(double p, double low, double size)
{
    double s = (p - low) / size * (PLANES + 1);
    return s < 0 ? 0 : s < PLANES ? (int)s : PLANES;
}

static struct bounds side_of(const struct plane *plane, int side)
{
    struct bounds s = plane->cell;
    if (side == LEFT)
        s.high[plane->axis] = plane->at;
    else
        s.low[plane->axis] = plane->at;
    return s;
}

/* The cheapest plane that has centres on both sides. Returns 0 when there is none. */
static int choose(const struct build *b, const struct part *p, struct plane *best)
{
    double least = INFINITY;
    int found = 0;
    for (int axis = 0; axis < 3; axis++) {
        double low = INFINITY, high = -INFINITY;
        uint32_t starts[PLANES + 1] = {0}, ends[PLANES + 1] = {0}, left = 0,
                                 right = p->to - p->from;
        for (uint32_t i = p->from; i < p->to; i++) {
            double c = item_centre(&b->items[i], axis);
            low = fmin(low, c);
            high = fmax(high, c);
        }
        if (!(high > low))
            continue;
        for (uint32_t i = p->from; i < p->to; i++) {
            starts[slice(b->items[i].box.low[axis], low, high - low)]++;
            ends[slice(b->items[i].box.high[axis], low, high - low)]++;
        }
        for (int j = 0; j < PLANES; j++) { /* the plane between slices j and j + 1 */
            const struct plane plane = {best->cell, axis,
                                        low + (j + 1) * (high - low) / (PLANES + 1)};
            const struct bounds l = side_of(&plane, LEFT), r = side_of(&plane, RIGHT);
            left += starts[j];
            right -= ends[j];
            double cost = bounds_area(&l) * left + bounds_area(&r) * right;
            if (plane.at > low && cost < least) {
                least = cost;
                *best = plane;
                found = 1;
            }
        }
    }
    return found;
}

static int kind(const struct item *x, const void *context)
{
    const struct plane *p = context;
    int side = item_centre(x, p->axis) >= p->at;
    double wide = side ? p->cell.high[p->axis] - p->at : p->at - p->cell.low[p->axis];
    return x->box.high[p->axis] - x->box.low[p->axis] > wide ? STAYS : side ? RIGHT : LEFT;
}

/* Cut a part in two or three. Returns how many. */
static int cut(const struct build *b, const struct part *whole, struct part *parts, int threads)
{
    struct plane plane = {.cell = whole->cell};
    uint32_t count[KINDS] = {0}, from = whole->from;
    int k, n = 0;
    if (whole->at == CELL) {
        struct bounds content;
        bounds_empty(&content);
        for (uint32_t i = whole->from; i < whole->to; i++)
            bounds_add(&content, &b->items[i].box);
        for (k = 0; k < 3; k++) {
            plane.cell.low[k] = fmax(plane.cell.low[k], content.low[k]);
            plane.cell.high[k] = fmin(plane.cell.high[k], content.high[k]);
        }
        if (choose(b, whole, &plane))
            build_sort(b, whole, KINDS, kind, &plane, count);
    }
    for (k = 0; k < KINDS; k++)
        n += count[k] > 0;
    if (n < 2) { /* nothing to tell them apart by */
        parts[0] = parts[1] = *whole;
        parts[0].to = parts[1].from = build_cut(b, whole->from, whole->to, threads);
        if (count[STAYS])
            parts[0].at = parts[1].at = BOXES;
        return 2;
    }
    for (n = 0, k = 0; k < KINDS; k++) {
        if (count[k])
            parts[n++] = (struct part){from, from + count[k], k == STAYS ? BOXES : CELL,
                                       k == STAYS ? plane.cell : side_of(&plane, k)};
        from += count[k];
    }
    return n;
}

static int divide(const struct build *b, const struct part *whole, struct part *parts, int threads)
{
    return build_cut_thrice(b, whole, parts, threads, cut);
}

const struct strategy build_kd = {NULL, divide, NULL};
