/* mates.c - who stands across each edge of what stands in shafts.
 *
 * Edges are sorted by the places of their ends. What is one place is as coarse as groups' faces
 * reach out of their planes: outlines of groups are computed, and miss the corners of their
 * neighbours by rounding. Two elements alone at an edge are mates. Of more, as where a wall's cells
 * end at the edge of a box that stands there, those are that have a solid between them, behind
 * both: as one turns around the edge, where it begins and where it ends, one after the other; of an
 * odd number one is left over. Invariant: mates are mutual.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "hierarchy/mates.h"
#include "hierarchy/places.h"
#include "kernel/lambert.h"

struct mate_edge {
    uint32_t end[2]; /* places, the smaller one first */
    uint32_t element;
    uint8_t side, turned; /* turned: it runs from the larger end to the smaller */
};

struct edge_list {
    const struct hierarchy *h;
    struct mate_edge *edges; /* of each element one after the other */
    struct corner *corners;  /* where they begin */
    size_t count;
};

static int compare_edges(const void *a, const void *b)
{
    const struct mate_edge *x = a, *y = b;
    for (int end = 0; end < 2; end++)
        if (x->end[end] != y->end[end])
            return x->end[end] < y->end[end] ? -1 : 1;
    return x->element < y->element ? -1 : x->element > y->element ? 1 : x->side - y->side;
}

static int one_edge(const struct mate_edge *a, const struct mate_edge *b)
{
    return a->end[0] == b->end[0] && a->end[1] == b->end[1];
}

static void add_edges(struct edge_list *list, uint32_t index)
{
    const struct element *e = &list->h->elements[index];
    for (int i = 0; i < e->vertices; i++, list->count++) {
        list->edges[list->count] = (struct mate_edge){.element = index, .side = (uint8_t)i};
        list->corners[list->count] = (struct corner){e->vertex[i], list->count};
    }
}

/* Sets the ends of all edges. Those whose ends are one place are left out. */
static void set_ends(struct edge_list *list, const uint32_t *place)
{
    size_t kept = 0;
    for (size_t i = 0; i < list->count; i++) {
        struct mate_edge edge = list->edges[i];
        const int last = edge.side + 1 == list->h->elements[edge.element].vertices;
        const uint32_t from = place[i], to = place[last ? i - edge.side : i + 1];
        edge.turned = from > to;
        edge.end[edge.turned] = from;
        edge.end[!edge.turned] = to;
        if (from != to)
            list->edges[kept++] = edge;
    }
    list->count = kept;
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

static void find_mates(struct mates *mates, const struct edge_list *list)
{
    struct mate_edge *edges = list->edges;
    qsort(edges, list->count, sizeof *edges, compare_edges);
    for (size_t from = 0, to; from < list->count; from = to) {
        for (to = from + 1; to < list->count && one_edge(&edges[from], &edges[to]); to++)
            ;
        if (to - from == 2)
            make_mates(mates, &edges[from], &edges[from + 1]);
        else if (to - from > 2)
            turn_around(mates, list->h, &edges[from], to - from);
    }
}

int mates_open(struct mates *mates, const struct hierarchy *h)
{
    const size_t most = 4 * (size_t)h->face_count;
    struct edge_list list = {h, malloc(most * sizeof *list.edges),
                             malloc(most * sizeof *list.corners), 0};
    uint32_t *place = malloc(most * sizeof *place);
    mates->of = malloc(h->built * sizeof *mates->of);
    const int ready = list.edges && list.corners && place && mates->of;
    for (uint32_t i = 0; i < h->built && ready; i++)
        for (int k = 0; k < 4; k++)
            mates->of[i][k] = NO_MATE;
    if (ready) {
        collect(&list, 0);
        places_find(list.corners, list.count, PLACES_APART * h->flat, place);
        set_ends(&list, place);
        find_mates(mates, &list);
    }
    free(list.edges);
    free(list.corners);
    free(place);
    return ready ? 0 : -1;
}

void mates_close(struct mates *mates)
{
    free(mates->of);
    mates->of = NULL;
}
