/* mates.c - who stands across each edge of what stands in shafts.
 *
 * Edges are sorted by the places of their ends, on a grid as coarse as groups' faces reach out of
 * their planes: outlines of groups are computed, and miss the corners of their neighbours by
 * rounding. Two elements alone at an edge are mates. Of more, as where a wall's cells end at the
 * edge of a box that stands there, those are that have a solid between them, behind both: as one
 * turns around the edge, where it begins and where it ends, one after the other; of an odd number
 * one is left over.
 * Ends that fall in two cells of the grid though they are one place lose a mate, which nobody may
 * rely on to be there.
 * Invariant: mates are mutual.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "hierarchy/mates.h"
#include "kernel/lambert.h"

struct mate_edge {
    double end[2][3]; /* the smaller one first */
    uint32_t element;
    uint8_t side, turned; /* turned: it runs from the larger end to the smaller */
};

struct edge_list {
    const struct hierarchy *h;
    struct mate_edge *edges;
    size_t count;
};

static int compare_ends(const double *a, const double *b, int n)
{
    for (int k = 0; k < n; k++)
        if (a[k] < b[k] || a[k] > b[k])
            return a[k] < b[k] ? -1 : 1;
    return 0;
}

static int compare_edges(const void *a, const void *b)
{
    const struct mate_edge *x = a, *y = b;
    int order = compare_ends(x->end[0], y->end[0], 6);
    if (order)
        return order;
    return x->element < y->element ? -1 : x->element > y->element ? 1 : x->side - y->side;
}

static void add_edges(struct edge_list *list, uint32_t index)
{
    const struct element *e = &list->h->elements[index];
    double cell = 8 * list->h->flat;
    for (int i = 0; i < e->vertices; i++) {
        struct mate_edge edge = {.element = index, .side = (uint8_t)i};
        const double *v[2] = {e->vertex[i], e->vertex[i + 1 < e->vertices ? i + 1 : 0]};
        for (int end = 0; end < 2; end++)
            for (int k = 0; k < 3; k++)
                edge.end[end][k] = cell > 0 ? floor(v[end][k] / cell + 0.5) : v[end][k];
        int order = compare_ends(edge.end[0], edge.end[1], 3);
        if (order == 0)
            continue;
        if (order > 0) {
            double swap[3];
            memcpy(swap, edge.end[0], sizeof swap);
            memcpy(edge.end[0], edge.end[1], sizeof swap);
            memcpy(edge.end[1], swap, sizeof swap);
            edge.turned = 1;
        }
        list->edges[list->count++] = edge;
    }
}

/* What stands in shafts below an element, as candidates.c finds it. */
static void collect(struct edge_list *list, uint32_t index)
{
    const struct hierarchy *h = list->h;
    const struct element *e = &h->elements[index];
    if (h->solid[index]) {
        if (!h->faces[h->order[h->range[index].from]].back)
            add_edges(list, index);
        return;
    }
    for (uint32_t c = 0; c < e->children; c++)
        collect(list, e->child + c);
}

static void make_mates(struct mates *mates, const struct mate_edge *a, const struct mate_edge *b)
{
    mates->of[a->element][a->side] = 2 * (int64_t)b->element + (a->turned == b->turned);
    mates->of[b->element][b->side] = 2 * (int64_t)a->element + (a->turned == b->turned);
}

/* Elements at an edge that make a turn around it: more are left alone. Angles that are one, chosen:
 * elements in a plane differ by rounding. */
enum { TURN = 8 };
static const double TURN_SAME = 1e-6;

/* The direction from an edge into its element, and that of the edge as the element runs along it.
 */
static void into(const struct element *e, int side, double along[3], double w[3])
{
    sub3(along, e->vertex[side + 1 < e->vertices ? side + 1 : 0], e->vertex[side]);
    cross3(w, e->normal, along);
}

/* Of more than two elements at an edge. What runs along it from the larger end has its back behind
 * it as one turns around the edge, so that a solid begins there, and ends at the next that runs the
 * other way. */
static void turn_around(struct mates *mates, const struct hierarchy *h, struct mate_edge *edges,
                        size_t count)
{
    double angle[TURN], u[3], v[3], axis[3];
    size_t first = 0;
    while (first < count && !edges[first].turned)
        first++;
    if (count > TURN || first == count)
        return;
    const struct mate_edge start = edges[first];
    edges[first] = edges[0];
    edges[0] = start;
    into(&h->elements[start.element], start.side, axis, u); /* the axis runs backward */
    cross3(v, u, axis);
    const double longer = length3(v) / length3(u);
    for (size_t i = 0; i < count; i++) {
        const struct mate_edge edge = edges[i];
        double along[3], w[3];
        size_t at = i;
        into(&h->elements[edge.element], edge.side, along, w);
        double turn = i ? atan2(dot3(w, v), longer * dot3(w, u)) : 0;
        if (turn < (edge.turned ? -TURN_SAME : TURN_SAME))
            turn += 2 * LAMBERT_PI;
        turn -= edge.turned ? 0 : TURN_SAME; /* one ends before the next begins */
        for (; at > 0 && angle[at - 1] > turn; at--) {
            angle[at] = angle[at - 1];
            edges[at] = edges[at - 1];
        }
        angle[at] = turn;
        edges[at] = edge;
    }
    size_t alike = 0;
    for (size_t i = 0; i < count; i++)
        alike += edges[i].turned == edges[(i + 1) % count].turned;
    for (size_t i = 0; i < count && alike <= count % 2; i++)
        if (edges[i].turned && !edges[(i + 1) % count].turned)
            make_mates(mates, &edges[i], &edges[(i + 1) % count]);
}

int mates_open(struct mates *mates, const struct hierarchy *h)
{
    struct edge_list list = {h, malloc(4 * (size_t)h->face_count * sizeof *list.edges), 0};
    mates->of = malloc(h->built * sizeof *mates->of);
    if (!list.edges || !mates->of) {
        free(list.edges);
        return -1;
    }
    for (uint32_t i = 0; i < h->built; i++)
        for (int k = 0; k < 4; k++)
            mates->of[i][k] = NO_MATE;
    collect(&list, 0);
    qsort(list.edges, list.count, sizeof *list.edges, compare_edges);
    for (size_t from = 0, to; from < list.count; from = to) {
        struct mate_edge *a = &list.edges[from];
        for (to = from + 1; to < list.count; to++)
            if (compare_ends(a->end[0], list.edges[to].end[0], 6) != 0)
                break;
        if (to - from == 2)
            make_mates(mates, a, a + 1);
        else if (to - from > 2)
            turn_around(mates, h, a, to - from);
    }
    free(list.edges);
    return 0;
}

void mates_close(struct mates *mates)
{
    free(mates->of);
    mates->of = NULL;
}
