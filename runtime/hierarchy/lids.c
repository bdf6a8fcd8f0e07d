/* lids.c - see lids.h.
 *
 * A part of the face is cut in two by the line of some lid's edge, the halves again, until each
 * part is either under a lid or beside it: a binary space partition by edges [Fuchs, Kedem and
 * Naylor 1980]. Of a few lines that one is taken that leaves the fewest lids on both sides, so n
 * lids that lie side by side take n log n steps.
 *
 * Invariant: the parts are convex and disjoint, and where a part is bare no lid lies. It ends, for
 * no line that has been cut along is crossed by a part of what it cut.
 * SPDX-License-Identifier: MIT */
#include "hierarchy/lids.h"

#include <math.h>
#include <string.h>

#include "geometry.h"
#include "hierarchy/reach.h"
#include "util/array.h"

enum { LINES_TRIED = 16, CORNERS = POLYGON_CORNERS };

struct taker {
    struct bare_parts *bare;
    const struct lid *lids;
};

void lid_of(struct lid *lid, const double (*vertex)[3], uint32_t n, const double normal[3],
            double touch)
{
    lid->n = n;
    lid->touch = touch;
    memcpy(lid->corner, vertex, n * sizeof *vertex);
    double own[3];
    polygon_normal(lid->corner, n, own);
    for (uint32_t i = 0; i < n && dot3(own, normal) < 0; i++)
        memcpy(lid->corner[i], vertex[n - 1 - i], sizeof *vertex);
    for (uint32_t i = 0; i < n; i++) {
        double edge[3];
        sub3(edge, lid->corner[(i + 1) % n], lid->corner[i]);
        cross3(lid->across[i], normal, edge);
        double length = length3(lid->across[i]);
        for (int k = 0; k < 3; k++)
            lid->across[i][k] /= length > 0 ? length : 1;
    }
}

/* Of a polygon over an edge of a lid: how far it reaches, inwards and outwards (m). */
static void reach(const struct lid *lid, uint32_t edge, const double (*vertex)[3], uint32_t n,
                  double *low, double *high)
{
    *low = INFINITY;
    *high = -INFINITY;
    polygon_reach(vertex, n, lid->corner[edge], lid->across[edge], high, low);
}

enum lid_place lid_place(const struct lid *lid, const double (*vertex)[3], uint32_t n)
{
    enum lid_place place = UNDER;
    for (uint32_t e = 0; e < lid->n; e++) {
        double low, high;
        reach(lid, e, vertex, n, &low, &high);
        if (!(high > lid->touch))
            return BESIDE;
        place = low < -lid->touch ? ACROSS : place;
    }
    return place;
}

int lid_common(const struct lid *lid, const double (*vertex)[3], uint32_t n,
               double part[LID_COMMON][3])
{
    double h[LID_COMMON], other[LID_COMMON][3], (*now)[3] = part, (*next)[3] = other;
    int count = (int)n;
    memcpy(part, vertex, n * sizeof *vertex);
    for (uint32_t e = 0; e < lid->n && count >= 3; e++) {
        double(*left)[3] = next;
        for (int i = 0; i < count; i++)
            h[i] = height3(now[i], lid->corner[e], lid->across[e]);
        count = polygon_divide(&now[0][0], count, 3, h, LID_COMMON, &left[0][0], NULL, NULL);
        next = now;
        now = left;
    }
    if (now != part && count > 0)
        memcpy(part, now, (size_t)count * sizeof *part);
    return count;
}

double lid_area(const struct lid *lid, const double (*vertex)[3], uint32_t n,
                const double normal[3])
{
    double part[LID_COMMON][3], twice = 0;
    const int count = lid_common(lid, vertex, n, part);
    for (int i = 2; i < count; i++) {
        double a[3], b[3], c[3];
        sub3(a, part[i - 1], part[0]);
        sub3(b, part[i], part[0]);
        cross3(c, a, b);
        twice += dot3(c, normal);
    }
    return twice / 2;
}

/* ---- cutting */

/* Where the lid's edge crosses the part: 1. */
static int is_crossed(const struct lid *lid, uint32_t edge, const struct bare_part *p)
{
    double low, high;
    reach(lid, edge, (const double(*)[3])p->vertex, p->n, &low, &high);
    return low < -lid->touch && high > lid->touch;
}

/* The larger number of lids on one side of an edge's line; those across count twice. */
static size_t lids_left(const struct taker *t, const struct lid *by, uint32_t edge,
                        const uint32_t *on, size_t count)
{
    size_t in = 0, out = 0, both = 0;
    for (size_t i = 0; i < count; i++) {
        const struct lid *l = &t->lids[on[i]];
        double low = INFINITY, high = -INFINITY;
        for (uint32_t k = 0; k < l->n; k++) {
            double h = height3(l->corner[k], by->corner[edge], by->across[edge]);
            low = fmin(low, h);
            high = fmax(high, h);
        }
        if (low >= -by->touch)
            in++;
        else if (high <= by->touch)
            out++;
        else
            both++;
    }
    return (in > out ? in : out) + 2 * both;
}

/* The edge to cut along. Some edge of every lid across the part crosses it. */
static const struct lid *choose_edge(const struct taker *t, const struct bare_part *p,
                                     const uint32_t *on, size_t count, uint32_t *edge)
{
    const struct lid *best = NULL;
    size_t least = SIZE_MAX, tried = count < LINES_TRIED ? count : LINES_TRIED;
    for (size_t i = 0; i < tried; i++) {
        const struct lid *l = &t->lids[on[i * count / tried]];
        for (uint32_t e = 0; e < l->n; e++) {
            if (!is_crossed(l, e, p))
                continue;
            size_t left = lids_left(t, l, e, on, count);
            if (left < least) {
                least = left;
                best = l;
                *edge = e;
            }
            if (count >= LINES_TRIED)
                break; /* one of each */
        }
    }
    return best;
}

static int add_bare(struct bare_parts *bare, const struct bare_part *p)
{
    if (array_reserve(&bare->parts, bare->count + 1, &bare->capacity, sizeof *bare->parts) < 0)
        return -1;
    bare->parts[bare->count++] = *p;
    return 0;
}

/* A part with many corners in two, along a diagonal. */
static void halve(const struct bare_part *p, struct bare_part half[2])
{
    uint32_t middle = p->n / 2;
    for (int k = 0; k < 2; k++) {
        half[k] = (struct bare_part){.sides = p->sides};
        for (uint32_t i = k ? middle : 0; i <= (k ? p->n : middle); i++)
            memcpy(half[k].vertex[half[k].n++], p->vertex[i % p->n], sizeof p->vertex[0]);
    }
}

static void divide(const struct bare_part *p, const struct lid *by, uint32_t edge,
                   struct bare_part half[2])
{
    double h[CORNERS];
    int below;
    for (uint32_t i = 0; i < p->n; i++) {
        h[i] = height3(p->vertex[i], by->corner[edge], by->across[edge]);
        if (fabs(h[i]) <= by->touch)
            h[i] = 0;
    }
    half[0].n = (uint32_t)polygon_divide(&p->vertex[0][0], (int)p->n, 3, h, CORNERS,
                                         &half[0].vertex[0][0], &half[1].vertex[0][0], &below);
    half[1].n = (uint32_t)below;
    half[0].sides = half[1].sides = p->sides;
}

/* Take from a part what is under those lids. Returns 0 or -1. */
static int uncover(const struct taker *t, struct bare_part p, const uint32_t *lids, size_t count)
{
    uint32_t *on = malloc((count + 1) * sizeof *on), edge = 0;
    struct bare_part half[2];
    size_t across = 0, left = 0;
    if (!on)
        return -1;
    for (size_t i = 0; i < count; i++) {
        const struct lid *l = &t->lids[lids[i]];
        if (!(l->sides & p.sides))
            continue;
        enum lid_place place = lid_place(l, (const double(*)[3])p.vertex, p.n);
        if (place == UNDER)
            p.sides &= ~l->sides;
        else if (place == ACROSS)
            on[across++] = lids[i];
    }
    for (size_t i = 0; i < across; i++)
        if (t->lids[on[i]].sides & p.sides)
            on[left++] = on[i];
    const struct lid *by = left ? choose_edge(t, &p, on, left, &edge) : NULL;
    int result = 0;
    if (p.sides && !by) {
        result = add_bare(t->bare, &p);
    } else if (p.sides) {
        if (p.n == CORNERS)
            halve(&p, half);
        else
            divide(&p, by, edge, half);
        result = uncover(t, half[0], on, left) || uncover(t, half[1], on, left) ? -1 : 0;
    }
    free(on);
    return result;
}

int lids_take(struct bare_parts *bare, const struct face *face, unsigned sides,
              const struct lid *lids, uint32_t count)
{
    struct bare_part whole = {.n = face->vertices, .sides = sides};
    uint32_t *all = malloc(((size_t)count + 1) * sizeof *all);
    if (!all)
        return -1;
    memcpy(whole.vertex, face->vertex, face->vertices * sizeof face->vertex[0]);
    for (uint32_t i = 0; i < count; i++)
        all[i] = i;
    int result = uncover(&(struct taker){bare, lids}, whole, all, count);
    free(all);
    return result;
}
