/* solids.c - convex solids of any number of faces.
 *
 * As bodies.c, but of no corner in front of a plane by more than rounding: of a mesh an outline is
 * told edge by edge (engine/exchange_horizon.c), and what bends in where its edges are short leads
 * far astray. Most shells that bend in do so across an edge, which is asked first; the rest takes
 * every plane against every corner, once.
 * Invariant: a face is of one solid at most; a solid has no free edge, no bent face and no face
 * whose front looks inside.
 * [a closed surface that each of its planes supports is its hull's]
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "hierarchy/solids.h"

/* Of how far the solid's corners are from where coordinates begin: outlines of groups are computed;
 * chosen. */
static const double ROUNDS = 1e-12;

/* Shells at work. */
struct shells_walk {
    const struct hierarchy *h;
    const struct mates *mates;
    uint32_t *faces; /* [count]: of the shell at hand */
    uint32_t count;
    unsigned char *met; /* [built] */
    double rounds;      /* of the shell at hand (m) */
};

/* The faces that follow each other from one on, all of them. Returns 0 when some edge is free, or
 * a front looks inside where its neighbour's looks outside. */
static int follow(struct shells_walk *w, uint32_t from)
{
    int closed = 1;
    w->faces[0] = from;
    w->count = 1;
    w->met[from] = 1;
    for (uint32_t at = 0; at < w->count; at++)
        for (int i = 0; i < w->h->elements[w->faces[at]].vertices; i++) {
            const int64_t mate = w->mates->of[w->faces[at]][i];
            if (mate == NO_MATE || mate % 2) {
                closed = 0;
            } else if (!w->met[mate / 2]) {
                w->met[mate / 2] = 1;
                w->faces[w->count++] = (uint32_t)(mate / 2);
            }
        }
    return closed;
}

/* How far the corners of a face reach in front of a plane, and behind. */
static void reach(const struct element *plane, const struct element *e, double *high, double *low)
{
    for (int k = 0; k < e->vertices; k++) {
        const double height = height3(e->vertex[k], plane->vertex[0], plane->normal);
        *high = height > *high ? height : *high;
        *low = height < *low ? height : *low;
    }
}

/* Is every face flat, and no neighbour of it in front of its plane? */
static int bends_out(const struct shells_walk *w)
{
    for (uint32_t f = 0; f < w->count; f++) {
        const struct element *plane = &w->h->elements[w->faces[f]];
        double high = 0, low = 0, deep = 0;
        reach(plane, plane, &high, &low);
        if (high > w->rounds || low < -w->rounds)
            return 0;
        for (int i = 0; i < plane->vertices; i++)
            reach(plane, &w->h->elements[w->mates->of[w->faces[f]][i] / 2], &high, &deep);
        if (high > w->rounds)
            return 0;
    }
    return 1;
}

/* Does no corner lie in front of a plane, and some behind each by more than faces reach off theirs?
 * Else points in the plane of a plate were inside. */
static int is_convex(const struct shells_walk *w)
{
    for (uint32_t f = 0; f < w->count; f++) {
        const struct element *plane = &w->h->elements[w->faces[f]];
        double high = 0, low = 0;
        for (uint32_t g = 0; g < w->count && !(high > w->rounds); g++)
            reach(plane, &w->h->elements[w->faces[g]], &high, &low);
        if (high > w->rounds || !(low < -8 * w->h->flat))
            return 0;
    }
    return 1;
}

static double rounds_of(const struct shells_walk *w)
{
    double far = 0;
    for (uint32_t f = 0; f < w->count; f++) {
        const struct element *e = &w->h->elements[w->faces[f]];
        for (int i = 0; i < e->vertices; i++)
            for (int k = 0; k < 3; k++)
                far = fabs(e->vertex[i][k]) > far ? fabs(e->vertex[i][k]) : far;
    }
    return ROUNDS * far;
}

int solids_open(struct solids *s, const struct hierarchy *h, const struct mates *mates)
{
    const size_t room = (size_t)h->built + 1;
    struct shells_walk w = {.h = h, .mates = mates};
    memset(s, 0, sizeof *s);
    s->of = calloc(room, sizeof *s->of);
    w.faces = malloc(room * sizeof *w.faces);
    w.met = calloc(room, 1);
    const int failed = !s->of || !w.faces || !w.met;
    for (uint32_t i = 0; i < h->built && !failed; i++) {
        if (w.met[i] || mates->of[i][0] == NO_MATE || !follow(&w, i))
            continue;
        w.rounds = rounds_of(&w);
        if (!bends_out(&w) || !is_convex(&w))
            continue;
        s->count++;
        for (uint32_t f = 0; f < w.count; f++)
            s->of[w.faces[f]] = s->count;
    }
    free(w.faces);
    free(w.met);
    return failed ? -1 : 0;
}

void solids_close(struct solids *s)
{
    free(s->of);
    memset(s, 0, sizeof *s);
}
