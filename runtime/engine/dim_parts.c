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

struct small_face {
    double at[DIMENSIONS], area;
    uint32_t face;
};

struct parts {
    struct small_face *list;
    double large;
    uint32_t next, *part;
};

/* The widest dimension of list[from..to), and the middle of it. Returns how wide it is. */
static double widest(const struct parts *p, uint32_t from, uint32_t to, int *dimension,
                     double *middle)
{
    double most = 0;
    for (int k = 0; k < DIMENSIONS; k++) {
        double low = INFINITY, high = -INFINITY;
        for (uint32_t i = from; i < to; i++) {
            low = fmin(low, p->list[i].at[k]);
            high = fmax(high, p->list[i].at[k]);
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
        double area = 0, middle = 0;
        int k = 0;
        for (uint32_t i = from; i < to; i++)
            area += p->list[i].area;
        if (!(area > p->large))
            return;
        if (!(area > 2 * p->large) || !(widest(p, from, to, &k, &middle) > 0))
            break;
        uint32_t split = from;
        for (uint32_t i = from; i < to; i++)
            if (p->list[i].at[k] < middle) {
                const struct small_face below = p->list[i];
                p->list[i] = p->list[split];
                p->list[split++] = below;
            }
        if (split == from) /* two neighbours among numbers: nothing lies below their middle */
            break;
        divide(p, from, split);
        from = split;
    }
    for (uint32_t i = from; i < to; i++)
        p->part[p->list[i].face] = p->next;
    p->next++;
}

/* Normals as long as half the longest side of the box of all centres. */
static void scale_normals(struct small_face *list, uint32_t count)
{
    double size = 0;
    for (int k = 0; k < 3; k++) {
        double low = INFINITY, high = -INFINITY;
        for (uint32_t i = 0; i < count; i++) {
            low = fmin(low, list[i].at[k]);
            high = fmax(high, list[i].at[k]);
        }
        size = fmax(size, high - low);
    }
    for (uint32_t i = 0; i < count; i++)
        for (int k = 3; k < DIMENSIONS; k++)
            list[i].at[k] *= 0.5 * size;
}

int dim_parts_find(const struct tracer *t, const double *area, double large, uint32_t *part,
                   uint32_t *count)
{
    const struct hierarchy *h = t->hierarchy;
    struct parts p = {malloc(((size_t)h->face_count + 1) * sizeof *p.list), large, *count, part};
    uint32_t small = 0;
    if (!p.list)
        return -1;
    for (uint32_t i = 0; i < h->face_count; i++) {
        const struct element *e = tracer_surface(t, i);
        if (!(area[part[i]] > 0) || area[part[i]] > large || !(tracer_reflectance(t, i) > 0))
            continue;
        struct small_face *f = &p.list[small++];
        for (int k = 0; k < 3; k++) {
            f->at[k] = e->centre[k];
            f->at[3 + k] = e->normal[k];
        }
        f->area = e->area;
        f->face = i;
    }
    scale_normals(p.list, small);
    divide(&p, 0, small);
    *count = p.next;
    free(p.list);
    return 0;
}
