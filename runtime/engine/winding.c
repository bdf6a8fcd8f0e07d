/* winding.c - see winding.h.
 *
 * The winding number of a point is the solid angle of all faces, those seen from behind counted
 * negative, over 4 pi. Crossing a face from its front to its back lowers it by one. If it is whole
 * at a few points of no special place, then the faces as a whole have no border (where they had one
 * it would change from point to point): they bound volumes, and the number is constant in each. A
 * ray that starts where it is 1 must come down to the 0 of far away, so it meets a face; the first
 * one is met from its front, unless it leads to a volume of number 2. So every leaf is asked for
 * its number just before it, and all must have 1, or 0 (which solids cover, or which no light
 * reaches).
 *
 * Three points by chance: a scene with a border for which all three are whole is a set of measure
 * 0. An opening that no point sees larger than WINDING_WHOLE is taken for a crack of rounding.
 * [Gauss; the solid angle of a triangle: Van Oosterom and Strackee 1983; the test: derived here]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdatomic.h>
#include <string.h>
#include "engine/winding.h"
#include "kernel/constants.h"
#include "kernel/hash.h"
#include "kernel/lambert.h"
#include "util/thread_pool.h"

enum { PLACES = 3 };
/* solid angles; as many take a second or two */
#define WINDING_WORK 1e8

/* Solid angle of a triangle, positive when seen counter-clockwise. */
static double triangle_angle(const double p[3], const double *a, const double *b, const double *c)
{
    double u[3], v[3], w[3], n[3];
    sub3(u, a, p);
    sub3(v, b, p);
    sub3(w, c, p);
    cross3(n, v, w);
    double x = length3(u), y = length3(v), z = length3(w);
    return -2 * atan2(dot3(u, n), x * y * z + dot3(u, v) * z + dot3(v, w) * x + dot3(w, u) * y);
}

static double winding_number(const struct hierarchy *h, const double p[3])
{
    double sum = 0;
    for (uint32_t i = 0; i < h->face_count; i++) {
        const struct face *f = &h->faces[i];
        if (f->light == FACE_DARK)
            continue;
        for (uint32_t j = 2; j < f->vertices; j++)
            sum += triangle_angle(p, f->vertex[0], f->vertex[j - 1], f->vertex[j]);
    }
    return sum / (4 * LAMBERT_PI);
}

static int is_whole(double number)
{
    return fabs(number - floor(number + 0.5)) <= WINDING_WHOLE;
}

/* Have the faces no border? */
static int bounds_volumes(const struct hierarchy *h)
{
    uint64_t chance = HASH_STEP;
    for (int i = 0; i < PLACES; i++) {
        double p[3];
        for (int k = 0; k < 3; k++) {
            chance = hash64(chance);
            p[k] = h->low[k] + (double)(chance >> 11) * 0x1p-53 * (h->high[k] - h->low[k]);
        }
        if (!is_whole(winding_number(h, p)))
            return 0;
    }
    return 1;
}

/* The range of winding numbers before element e, by its centre and corners: [0] NAN where one is
 * not whole. */
static void numbers_before(const struct hierarchy *h, const struct element *e, double off,
                           double range[2])
{
    range[0] = INFINITY;
    range[1] = -INFINITY;
    for (int i = 0; i <= e->vertices; i++) {
        double p[3];
        for (int k = 0; k < 3; k++) {
            p[k] = e->centre[k] + off * e->normal[k];
            if (i)
                p[k] += WINDING_INSET * (e->vertex[i - 1][k] - e->centre[k]);
        }
        double number = winding_number(h, p);
        range[0] = is_whole(number) ? fmin(range[0], number) : NAN;
        range[1] = fmax(range[1], number);
    }
}

struct numbering {
    const struct hierarchy *h;
    const double *uncovered; /* [element] */
    double offset;           /* m */
    unsigned char *closed;   /* [element] */
    atomic_int *nested;
};

static void number_leaves(const void *numbering, size_t from, size_t to)
{
    const struct numbering *n = numbering;
    for (size_t i = from; i < to; i++) {
        const struct element *e = &n->h->elements[i];
        double range[2];
        if (!e->vertices || e->children)
            continue;
        numbers_before(n->h, e, n->offset, range);
        n->closed[i] = range[0] > 0.5 && range[1] < 1.5;
        if (range[1] > 1.5 && n->uncovered[i] > 0)
            *n->nested = 1;
    }
}

void winding_closed(const struct hierarchy *h, const double *uncovered, int threads,
                    unsigned char *closed)
{
    double extent = 0;
    size_t leaves = 0;
    atomic_int nested = 0;
    memset(closed, 0, h->count);
    for (int k = 0; k < 3; k++)
        extent = fmax(extent, h->high[k] - h->low[k]);
    for (uint32_t i = 0; i < h->count; i++)
        leaves += h->elements[i].vertices && !h->elements[i].children;
    if ((double)leaves * 5 * h->face_count > WINDING_WORK || !bounds_volumes(h))
        return;
    const struct numbering n = {h, uncovered, RAY_OFFSET * extent, closed, &nested};
    thread_pool_run(threads, h->count, 16, number_leaves, &n);
    if (nested)
        memset(closed, 0, h->count);
}
