/* sides.c - see sides.h.
 *
 * Around an edge stand the faces that share it, in an order; two that follow each other bound one
 * space with the sides they turn to each other, and a face that stands there alone does so with
 * both of its own: light gets around it. An edge may run through another face, as where a box
 * without a bottom stands on the floor: then nothing gets around it there, and that face bounds the
 * spaces on either side of it in parts; or along a longer edge: so the faces around it are asked
 * stretch by stretch. Edges need not be equal: what is nearer than CUT_TOUCH is at one place. What
 * is not sure is joined, so that spaces come out too large rather than too small, as where faces
 * lie on each other. [Faces in their order around an edge: radial edges, Weiler 1986; as maps:
 * Tarjan 1975]
 * SPDX-License-Identifier: MIT */
#include "hierarchy/sides.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "geometry.h"
#include "kernel/constants.h"
#include "kernel/hemisphere.h"
#include "kernel/lambert.h"
#include "util/array.h"
#include "util/thread_pool.h"

enum { AROUND = 64 }; /* faces that touch an edge */
enum { RUN = 1024 };  /* edges that a thread takes at a time */

/* An edge of a face, its smaller end first. */
struct edge {
    double end[2][3];
    uint32_t face;
};

/* A face as it stands around an edge, by its angle: half a plane. Sides look on towards larger
 * angles, and back. */
struct wing {
    double angle;
    uint32_t on, back;
    int whole; /* of a face that the edge runs through; its sides say nothing */
};

/* Sides that face each other across an edge. */
struct pairs {
    uint32_t (*sides)[2]; /* [count] */
    size_t count, capacity;
};

/* A stretch of an edge that a face touches, in lengths of the edge. */
struct stretch {
    double from, to;
    uint32_t face;
};

/* An edge as it is looked at; square to it are across.u and across.v. */
struct axis {
    const struct hierarchy *h;
    const struct edge *edge; /* [shared]: of so many faces */
    size_t shared;
    struct hemisphere across;
    double along[3], length, touch; /* m; nearer than that is the same place */
    double low[3], high[3];         /* box of what is nearer than touch (m) */
};

uint32_t sides_space(struct sides *s, uint32_t side)
{
    while (s->up[side] != side)
        side = s->up[side] = s->up[s->up[side]];
    return side;
}

void sides_join(struct sides *s, uint32_t a, uint32_t b)
{
    uint32_t x = sides_space(s, a), y = sides_space(s, b);
    s->up[x < y ? y : x] = x < y ? x : y;
}

static const struct element *element_of(const struct hierarchy *h, uint32_t face)
{
    return &h->elements[h->face_element[face]];
}

static int compare_edges(const void *a, const void *b)
{
    const struct edge *x = a, *y = b;
    for (int i = 0; i < 6; i++) {
        double p = x->end[i / 3][i % 3], q = y->end[i / 3][i % 3];
        if (p < q || p > q)
            return p < q ? -1 : 1;
    }
    return (x->face > y->face) - (x->face < y->face);
}

static int same_edge(const struct edge *a, const struct edge *b)
{
    struct edge c = *b;
    c.face = a->face;
    return compare_edges(a, &c) == 0;
}

/* All edges of faces that are no far sides. Returns how many. */
static size_t list_edges(const struct hierarchy *h, struct edge *edges)
{
    size_t count = 0;
    for (uint32_t f = 0; f < h->face_count; f++) {
        const struct face *face = &h->faces[f];
        for (uint32_t i = 0; i < face->vertices && !face->back; i++) {
            struct edge *e = &edges[count++];
            const double *a = face->vertex[i], *b = face->vertex[(i + 1) % face->vertices];
            int order = 0;
            for (int k = 0; k < 3 && order == 0; k++)
                order = (a[k] > b[k]) - (a[k] < b[k]);
            for (int k = 0; k < 3; k++) {
                e->end[0][k] = (order > 0 ? b : a)[k] + 0.0; /* -0 is 0 */
                e->end[1][k] = (order > 0 ? a : b)[k] + 0.0;
            }
            e->face = f;
        }
    }
    return count;
}

/* Returns 0 when the edge is a point. */
static int axis_of(struct axis *x, const struct hierarchy *h, const struct edge *edge,
                   size_t shared, double precision)
{
    const struct element *e = element_of(h, edge->face);
    double largest = 0;
    for (int k = 0; k < 3; k++)
        largest = fmax(largest, fmax(fabs(edge->end[0][k]), fabs(edge->end[1][k])));
    *x = (struct axis){.h = h, .edge = edge, .shared = shared};
    x->touch = fmax(CUT_TOUCH * e->radius, CUT_TOUCH_ROUNDINGS * precision * largest);
    sub3(x->along, edge->end[1], edge->end[0]);
    x->length = length3(x->along);
    if (!(x->length > 0))
        return 0;
    for (int k = 0; k < 3; k++) {
        x->along[k] /= x->length;
        x->low[k] = fmin(edge->end[0][k], edge->end[1][k]) - x->touch;
        x->high[k] = fmax(edge->end[0][k], edge->end[1][k]) + x->touch;
    }
    x->across = hemisphere_over(x->along);
    return 1;
}

/* The wing of a face in this direction from the edge. */
static struct wing wing_of(const struct axis *x, uint32_t face, const double direction[3],
                           int whole)
{
    double over[3];
    cross3(over, x->along, direction);
    const uint32_t behind = dot3(over, element_of(x->h, face)->normal) > 0;
    return (struct wing){atan2(dot3(direction, x->across.v), dot3(direction, x->across.u)),
                         2 * face + 1 - behind, 2 * face + behind, whole};
}

static int compare_wings(const void *a, const void *b)
{
    const struct wing *x = a, *y = b;
    return x->angle != y->angle ? (x->angle < y->angle ? -1 : 1)
                                : (x->on > y->on) - (x->on < y->on);
}

/* Returns 0, or -1 when out of memory. */
static int add_pair(struct pairs *pairs, uint32_t a, uint32_t b)
{
    if (array_reserve(&pairs->sides, pairs->count + 1, &pairs->capacity, sizeof *pairs->sides) < 0)
        return -1;
    pairs->sides[pairs->count][0] = a;
    pairs->sides[pairs->count++][1] = b;
    return 0;
}

/* Returns 0, or -1 when out of memory. */
static int pair_around(struct pairs *pairs, struct wing *wings, int count)
{
    int failed = 0;
    qsort(wings, (size_t)count, sizeof *wings, compare_wings);
    for (int i = 0; i < count && !failed; i++) {
        const struct wing *a = &wings[i], *b = &wings[i + 1 < count ? i + 1 : 0];
        if (a->whole || b->whole)
            continue;
        const double apart = b->angle - a->angle + (i + 1 < count ? 0 : 2 * LAMBERT_PI);
        failed = add_pair(pairs, a->on, b->back) < 0;
        if (count > 1 && apart < CUT_SAME_LINE) /* which comes first? */
            failed |= add_pair(pairs, a->on, a->back) < 0 || add_pair(pairs, b->on, b->back) < 0;
    }
    return failed ? -1 : 0;
}

/* From the edge into a face that has it for a border. */
static void inwards(const struct axis *x, uint32_t face, double direction[3])
{
    sub3(direction, element_of(x->h, face)->centre, x->edge->end[0]);
    double along = dot3(direction, x->along);
    for (int k = 0; k < 3; k++)
        direction[k] -= along * x->along[k];
}

/* Cut from the stretch where a x + b < 0, x in lengths of the edge. */
static void cut_stretch(struct stretch *s, double at_from, double at_to)
{
    double slope = at_to - at_from, zero = slope > 0 || slope < 0 ? -at_from / slope : 0;
    if (slope > 0)
        s->from = fmax(s->from, zero);
    else if (slope < 0)
        s->to = fmin(s->to, zero);
    else if (at_from < 0)
        s->to = s->from;
}

/* How far a point is inside of border i of a face, in its plane (m). */
static double inside_border(const struct element *e, int i, const double p[3])
{
    double side[3], in[3];
    sub3(side, e->vertex[(i + 1) % e->vertices], e->vertex[i]);
    cross3(in, e->normal, side);
    double length = length3(in);
    return length > 0 ? height3(p, e->vertex[i], in) / length : INFINITY;
}

static int is_long(const struct axis *x, const struct stretch *s)
{
    return (s->to - s->from) * x->length > 4 * x->touch;
}

/* The part of the edge that is nearer than touch to a face. Returns 0 where that is no more than
 * where it passes through. */
static int touches(const struct axis *x, uint32_t face, struct stretch *s)
{
    const struct element *e = element_of(x->h, face);
    const double(*end)[3] = x->edge->end;
    double low = height3(end[0], e->vertex[0], e->normal),
           high = height3(end[1], e->vertex[0], e->normal);
    *s = (struct stretch){0, 1, face};
    cut_stretch(s, low + x->touch, high + x->touch);
    cut_stretch(s, x->touch - low, x->touch - high);
    for (int i = 0; i < e->vertices && is_long(x, s); i++)
        cut_stretch(s, inside_border(e, i, end[0]) + x->touch,
                    inside_border(e, i, end[1]) + x->touch);
    return is_long(x, s);
}

/* Collect the stretches of the edge that faces below an element touch. Returns how many there are
 * then; AROUND: perhaps more. */
static int collect(const struct axis *x, uint32_t index, struct stretch *list, int count)
{
    const struct element *e = &x->h->elements[index];
    if (e->vertices) {
        if (count < AROUND && !x->h->faces[e->face].back)
            count += touches(x, e->face, &list[count]);
        return count;
    }
    for (int k = 0; k < 3; k++)
        if (e->vertex[0][k] > x->high[k] || e->vertex[1][k] < x->low[k])
            return count;
    for (uint32_t c = 0; c < e->children; c++)
        count = collect(x, e->child + c, list, count);
    return count;
}

/* Mark the sides of a face, through which the edge runs, that those that have it stand on. */
static void touch_sides(const struct sides *s, const struct axis *x, uint32_t face)
{
    const struct element *e = element_of(x->h, face);
    for (size_t i = 0; i < x->shared; i++) {
        double direction[3];
        inwards(x, x->edge[i].face, direction);
        const double over = dot3(direction, e->normal), slight = CUT_SAME_LINE * length3(direction);
        if (over > -slight)
            s->touched[2 * face] = 1;
        if (over < slight)
            s->touched[2 * face + 1] = 1;
    }
}

/* How a face stands around a point of the edge. Returns how many wings that makes. */
static int make_wings(const struct axis *x, uint32_t face, const double p[3], struct wing *wings)
{
    const struct element *e = element_of(x->h, face);
    double nearest = INFINITY, direction[3];
    for (int i = 0; i < e->vertices; i++)
        nearest = fmin(nearest, inside_border(e, i, p));
    if (nearest <= x->touch) {
        inwards(x, face, direction);
        wings[0] = wing_of(x, face, direction, 0);
        return 1;
    }
    cross3(direction, e->normal, x->along);
    wings[0] = wing_of(x, face, direction, 1);
    for (int k = 0; k < 3; k++)
        direction[k] = -direction[k];
    wings[1] = wing_of(x, face, direction, 1);
    return 2;
}

static int compare_numbers(const void *a, const void *b)
{
    const double *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

/* The stretches of an edge, each with what stands around it: mark what they run through, and pair
 * what follows each other. Returns 0, or -1 when out of memory. */
static int go_along(const struct sides *s, struct pairs *pairs, const struct axis *x)
{
    struct stretch list[AROUND];
    struct wing wings[2 * AROUND];
    double at[2 * AROUND] = {0, 1};
    int count = collect(x, 0, list, 0), places = 2, failed = 0;
    for (int i = 0; i < count && count < AROUND; i++) {
        at[places++] = list[i].from;
        at[places++] = list[i].to;
    }
    if (count == AROUND) {
        for (size_t i = 0; i < x->shared; i++) {
            s->touched[2 * x->edge[i].face] = 1;
            s->touched[2 * x->edge[i].face + 1] = 1;
        }
        return 0;
    }
    qsort(at, (size_t)places, sizeof *at, compare_numbers);
    for (int i = 1; i < places && !failed; i++) {
        double middle = 0.5 * (at[i - 1] + at[i]), p[3];
        int n = 0;
        if ((at[i] - at[i - 1]) * x->length <= 4 * x->touch)
            continue;
        for (int k = 0; k < 3; k++)
            p[k] = x->edge->end[0][k] + middle * (x->edge->end[1][k] - x->edge->end[0][k]);
        for (int j = 0; j < count; j++) {
            if (list[j].from > middle || list[j].to < middle)
                continue;
            int more = make_wings(x, list[j].face, p, &wings[n]);
            if (more == 2)
                touch_sides(s, x, list[j].face);
            n += more;
        }
        failed = pair_around(pairs, wings, n) < 0;
    }
    return failed ? -1 : 0;
}

/* All edges, in their order, and what each run of them finds. */
struct walk {
    const struct hierarchy *h;
    const struct sides *sides;
    double precision;
    const struct edge *edges; /* [count] */
    size_t count;
    size_t first;        /* of those that are walked here */
    struct pairs *pairs; /* [run] of these */
    atomic_int *failed;
};

/* Of edges that faces share the first is the run's. */
static void walk_edges(const void *walk, size_t from, size_t to)
{
    const struct walk *w = walk;
    for (size_t i = w->first + from; i < w->first + to; i++) {
        struct axis x;
        size_t shared = 1;
        if (i > 0 && same_edge(&w->edges[i - 1], &w->edges[i]))
            continue;
        while (i + shared < w->count && same_edge(&w->edges[i], &w->edges[i + shared]))
            shared++;
        if (axis_of(&x, w->h, &w->edges[i], shared, w->precision)
            && go_along(w->sides, &w->pairs[from / RUN], &x) < 0)
            *w->failed = 1;
    }
}

/* What runs have found, one after the other. Returns 0, or -1 when out of memory. */
static int add_runs(struct pairs *all, struct pairs *run, size_t runs)
{
    size_t count = 0;
    for (size_t r = 0; r < runs; r++)
        count += run[r].count;
    if (array_reserve(&all->sides, count + 1, &all->capacity, sizeof *all->sides) < 0)
        return -1;
    for (size_t r = 0; r < runs; r++) {
        if (run[r].count > 0)
            memcpy(all->sides + all->count, run[r].sides, run[r].count * sizeof *all->sides);
        all->count += run[r].count;
    }
    return 0;
}

/* What each rank has found, to all. Returns 0, or -1 on all when any is out of memory. */
static int share_pairs(struct sides *s, struct pairs *mine, struct ranks *ranks)
{
    const size_t n = (size_t)ranks_count(ranks), me = (size_t)ranks_number(ranks);
    size_t *first = malloc((n + 1) * sizeof *first);
    uint64_t *touched = malloc((s->far + (size_t)1) * sizeof *touched);
    uint32_t(*all)[2] = NULL;
    int failed = ranks_any(ranks, !first || !touched);
    if (!failed) {
        ranks_starts(ranks, RANKS_PAIRS, mine->count, first);
        all = malloc((first[n] + 1) * sizeof *all);
        failed = ranks_any(ranks, !all);
    }
    if (!failed) {
        if (mine->count > 0)
            memcpy(all + first[me], mine->sides, mine->count * sizeof *all);
        ranks_complete(ranks, RANKS_PAIRS, all, sizeof *all, first);
        free(mine->sides);
        *mine = (struct pairs){all, first[n], first[n]};
        for (uint32_t i = 0; i < s->far; i++)
            touched[i] = s->touched[i];
        ranks_add_counts(ranks, RANKS_PAIRS, touched, s->far);
        for (uint32_t i = 0; i < s->far; i++)
            s->touched[i] = touched[i] > 0;
    } else {
        free(all);
    }
    free(touched);
    free(first);
    return failed ? -1 : 0;
}

/* The pairs of all edges; each rank looks at its part of the runs. Returns 0, or -1 when out of
 * memory. */
static int find_pairs(struct sides *s, const struct hierarchy *h, double precision,
                      struct ranks *ranks, int threads, struct pairs *found)
{
    atomic_int failed = 0;
    struct edge *edges = malloc((4 * (size_t)h->face_count + 1) * sizeof *edges);
    if (edges) {
        const size_t count = list_edges(h, edges), all = (count + RUN - 1) / RUN;
        const int me = ranks_number(ranks);
        const size_t first = ranks_part(ranks, all, me) * RUN,
                     past = ranks_part(ranks, all, me + 1) * RUN,
                     mine = (past < count ? past : count) - (first < count ? first : count),
                     runs = (mine + RUN - 1) / RUN;
        struct pairs *run = calloc(runs + 1, sizeof *run);
        qsort(edges, count, sizeof *edges, compare_edges);
        const struct walk walk = {h, s, precision, edges, count, first, run, &failed};
        if (run)
            thread_pool_run(threads, mine, RUN, walk_edges, &walk);
        if (!run || add_runs(found, run, runs) < 0)
            failed = 1;
        for (size_t r = 0; run && r < runs; r++)
            free(run[r].sides);
        free(run);
    } else {
        failed = 1;
    }
    free(edges);
    if (ranks_any(ranks, failed))
        return -1;
    return ranks_count(ranks) > 1 ? share_pairs(s, found, ranks) : 0;
}

int sides_open(struct sides *s, const struct hierarchy *h, double precision, struct ranks *ranks,
               int threads)
{
    struct pairs found = {0};
    *s = (struct sides){.far = 2 * h->face_count};
    s->up = malloc(((size_t)s->far + 1) * sizeof *s->up);
    s->touched = calloc((size_t)s->far + 1, 1);
    const int failed = ranks_any(ranks, !s->up || !s->touched)
                       || find_pairs(s, h, precision, ranks, threads, &found) < 0;
    for (uint32_t i = 0; i <= s->far && !failed; i++)
        s->up[i] = i;
    /* of a side that bounds several spaces nobody knows which one this is */
    for (size_t i = 0; i < found.count && !failed; i++)
        if (!s->touched[found.sides[i][0]] && !s->touched[found.sides[i][1]])
            sides_join(s, found.sides[i][0], found.sides[i][1]);
    free(found.sides);
    return failed ? -1 : 0;
}

void sides_close(struct sides *s)
{
    free(s->up);
    free((void *)(uintptr_t)s->touched);
    *s = (struct sides){0};
}
