/* sides.c - see sides.h.
 *
 * Around an edge stand the faces that share it, in an order; two that follow each other bound one
 * space with the sides they turn to each other, and a face that stands there alone does so with
 * both of its own: light gets around it. An edge may run through another face, as where a box
 * without a bottom stands on the floor: then nothing gets around it there, and that face bounds the
 * spaces on either side of it in parts; or along a longer edge: so the faces around it are asked
 * stretch by stretch (edge_axis.h). What is not sure is joined, so that spaces come out too large
 * rather than too small, as where faces lie on each other. [Faces in their order around an edge:
 * radial edges, Weiler 1986; as maps: Tarjan 1975]
 * SPDX-License-Identifier: MIT */
#include "hierarchy/sides.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "geometry.h"
#include "hierarchy/edge_axis.h"
#include "kernel/constants.h"
#include "kernel/lambert.h"
#include "util/array.h"
#include "util/thread_pool.h"

enum { RUN = 1024 }; /* edges that a thread takes at a time */

/* Sides that face each other across an edge. */
struct pairs {
    uint32_t (*sides)[2]; /* [count] */
    size_t count, capacity;
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

/* Mark the sides of a face, through which the edge runs, that those that have it stand on. */
static void touch_sides(const struct sides *s, const struct edge_axis *x, uint32_t face)
{
    const struct element *e = hierarchy_surface(x->h, face);
    for (size_t i = 0; i < x->shared; i++) {
        double direction[3];
        edge_axis_inwards(x, x->edge[i].face, direction);
        const double over = dot3(direction, e->normal), slight = CUT_SAME_LINE * length3(direction);
        if (over > -slight)
            s->touched[2 * face] = 1;
        if (over < slight)
            s->touched[2 * face + 1] = 1;
    }
}

/* The stretches of an edge, each with what stands around it: mark what they run through, and pair
 * what follows each other. Returns 0, or -1 when out of memory. */
static int go_along(const struct sides *s, struct pairs *pairs, const struct edge_axis *x)
{
    struct stretch list[EDGE_FACES];
    struct wing wings[2 * EDGE_FACES];
    double at[2 * EDGE_FACES] = {0, 1};
    int count = edge_axis_touched(x, list), places = 2, failed = 0;
    for (int i = 0; i < count && count < EDGE_FACES; i++) {
        at[places++] = list[i].from;
        at[places++] = list[i].to;
    }
    if (count == EDGE_FACES) {
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
            int more = edge_axis_wings(x, list[j].face, p, &wings[n]);
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
        struct edge_axis x;
        size_t shared = 1;
        if (i > 0 && same_edge(&w->edges[i - 1], &w->edges[i]))
            continue;
        while (i + shared < w->count && same_edge(&w->edges[i], &w->edges[i + shared]))
            shared++;
        if (edge_axis_of(&x, w->h, &w->edges[i], shared, w->precision)
            && go_along(w->sides, &w->pairs[from / RUN], &x) < 0)
            *w->failed = 1;
    }
}

/* What runs of each rank have found, one after the other: to all. Returns 0, or -1 on all when any
 * is out of memory. */
static int gather_pairs(struct pairs *all, const struct pairs *run, size_t runs,
                        struct ranks *ranks)
{
    const size_t n = (size_t)ranks_count(ranks), me = (size_t)ranks_number(ranks);
    size_t *first = malloc((n + 1) * sizeof *first), count = 0;
    for (size_t r = 0; r < runs; r++)
        count += run[r].count;
    int failed = ranks_any(ranks, !first);
    if (!failed) {
        ranks_starts(ranks, RANKS_PAIRS, count, first);
        failed = ranks_any(
            ranks,
            array_reserve(&all->sides, first[n] + 1, &all->capacity, sizeof *all->sides) < 0);
    }
    if (!failed) {
        all->count = first[me];
        for (size_t r = 0; r < runs; r++) {
            if (run[r].count > 0)
                memcpy(all->sides + all->count, run[r].sides, run[r].count * sizeof *all->sides);
            all->count += run[r].count;
        }
        all->count = first[n];
        ranks_complete(ranks, RANKS_PAIRS, all->sides, sizeof *all->sides, first);
    }
    free(first);
    return failed ? -1 : 0;
}

/* What any rank has found touched is. Returns 0, or -1 on all when any is out of memory. */
static int share_touched(struct sides *s, struct ranks *ranks)
{
    if (ranks_count(ranks) == 1)
        return 0;
    uint64_t *times = malloc((s->far + (size_t)1) * sizeof *times);
    const int failed = ranks_any(ranks, !times);
    for (uint32_t i = 0; i < s->far && !failed; i++)
        times[i] = s->touched[i];
    if (!failed)
        ranks_add_counts(ranks, RANKS_PAIRS, times, s->far);
    for (uint32_t i = 0; i < s->far && !failed; i++)
        s->touched[i] = times[i] > 0;
    free(times);
    return failed ? -1 : 0;
}

/* The pairs of all edges; each rank looks at its part of the runs. Returns 0, or -1 on all when any
 * is out of memory. */
static int find_pairs(struct sides *s, const struct hierarchy *h, double precision,
                      struct ranks *ranks, int threads, struct pairs *found)
{
    atomic_int failed = 0;
    struct edge *edges = malloc((4 * (size_t)h->face_count + 1) * sizeof *edges);
    const size_t count = edges ? list_edges(h, edges) : 0, all = (count + RUN - 1) / RUN;
    const int me = ranks_number(ranks);
    const size_t first = ranks_part(ranks, all, me) * RUN,
                 past = ranks_part(ranks, all, me + 1) * RUN,
                 mine = (past < count ? past : count) - (first < count ? first : count),
                 runs = (mine + RUN - 1) / RUN;
    struct pairs *run = calloc(runs + 1, sizeof *run);
    if (edges && run) {
        qsort(edges, count, sizeof *edges, compare_edges);
        const struct walk walk = {h, s, precision, edges, count, first, run, &failed};
        thread_pool_run(threads, mine, RUN, walk_edges, &walk);
    }
    const int result = ranks_any(ranks, !edges || !run || failed)
                               || gather_pairs(found, run, runs, ranks) < 0
                               || share_touched(s, ranks) < 0
                           ? -1
                           : 0;
    for (size_t r = 0; run && r < runs; r++)
        free(run[r].sides);
    free(run);
    free(edges);
    return result;
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
