/* dim_parts.c - see dim_parts.h.
 *
 * What a room's walls are cut into is an accident of whoever made the mesh: a dim wall of 300 tiles
 * is as dark as one of a single polygon. So small faces are gathered, those that lie near each
 * other and look the same way, until they are as large as a large polygon. Faces are points in six
 * dimensions, centre and normal, normals as long as half the box of all centres: the set is halved
 * across its widest dimension while it is more than twice as large as asked. So the two sides of a
 * wall come apart first, then walls, then pieces of walls; of curved surfaces pieces that are
 * nearly flat. What is left over is too small to be a part.
 *
 * Invariant: parts depend on the faces alone.
 * [derived here]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include "engine/dim_parts.h"

enum { DIMENSIONS = 6 };

struct parts {
    const struct tracer *tracer;
    double large, reach; /* m2; what a normal is long (m) */
    uint32_t *list, *part, next;
};

static double key(const struct parts *p, uint32_t face, int k)
{
    const struct element *e = tracer_surface(p->tracer, face);
    return k < 3 ? e->centre[k] : p->reach * e->normal[k - 3];
}

static double area_of(const struct parts *p, uint32_t from, uint32_t to)
{
    double area = 0;
    for (uint32_t i = from; i < to; i++)
        area += tracer_surface(p->tracer, p->list[i])->area;
    return area;
}

/* The widest of the first dimensions of list[from..to), and the middle of it. Returns how wide it
 * is. */
static double widest(const struct parts *p, uint32_t from, uint32_t to, int dimensions,
                     int *dimension, double *middle)
{
    double most = 0;
    for (int k = 0; k < dimensions; k++) {
        double low = INFINITY, high = -INFINITY;
        for (uint32_t i = from; i < to; i++) {
            const double at = key(p, p->list[i], k);
            low = fmin(low, at);
            high = fmax(high, at);
        }
        if (high - low > most) {
            most = high - low;
            *dimension = k;
            *middle = 0.5 * (low + high);
        }
    }
    return most;
}

static void divide(struct parts *p, uint32_t from, uint32_t to)
{
    for (;;) {
        const double area = area_of(p, from, to);
        double middle = 0;
        int k = 0;
        if (!(area > p->large))
            return;
        if (!(area > 2 * p->large) || !(widest(p, from, to, DIMENSIONS, &k, &middle) > 0))
            break;
        uint32_t split = from;
        for (uint32_t i = from; i < to; i++)
            if (key(p, p->list[i], k) < middle) {
                const uint32_t below = p->list[i];
                p->list[i] = p->list[split];
                p->list[split++] = below;
            }
        if (split == from) /* two neighbours among numbers: nothing lies below their middle */
            break;
        divide(p, from, split);
        from = split;
    }
    for (uint32_t i = from; i < to; i++)
        p->part[p->list[i]] = p->next;
    p->next++;
}

int dim_parts_find(const struct tracer *t, const double *area, double large, uint32_t *part,
                   uint32_t *count)
{
    const uint32_t faces = t->hierarchy->face_count;
    struct parts p = {.tracer = t,
                      .large = large,
                      .list = malloc(((size_t)faces + 1) * sizeof *p.list),
                      .part = part,
                      .next = *count};
    uint32_t small = 0;
    double middle;
    int dimension;
    if (!p.list)
        return -1;
    for (uint32_t i = 0; i < faces; i++)
        if (area[part[i]] > 0 && area[part[i]] <= large && tracer_reflectance(t, i) > 0)
            p.list[small++] = i;
    p.reach = 0.5 * widest(&p, 0, small, 3, &dimension, &middle);
    divide(&p, 0, small);
    *count = p.next;
    free(p.list);
    return 0;
}
