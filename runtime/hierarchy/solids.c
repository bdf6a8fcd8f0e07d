/* solids.c - convex solids of any number of faces.
 *
 * As bodies.c, but of no corner in front of a plane by more than rounding: of a mesh an outline is
 * told edge by edge (engine/exchange_horizon.c), and what bends in where its edges are short leads
 * far astray. Most shells that bend in do so across an edge, which is asked first; then of every
 * plane whether any corner lies in front of it.
 * All of a solid lies behind the plane of each of its faces; a face that looks at something is
 * known by its normal, to the last digit, wherever its plane is asked of. Invariant: a face is of
 * one solid at most; a solid has no free edge, no bent face and no face whose front looks inside.
 * [a closed surface that each of its planes supports is its hull's]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "hierarchy/solids.h"
#include "hierarchy/reach.h"
#include "hierarchy/vector_hash.h"

/* Of how far the solid's corners are from where coordinates begin: outlines of groups are computed;
 * chosen. */
static const double ROUNDS = 1e-12;

enum { MET = 1, AT_HAND };

/* Shells at work. */
struct shells_walk {
    const struct hierarchy *h;
    const struct mates *mates;
    uint32_t *faces; /* [count]: of the shell at hand */
    uint32_t count;
    unsigned char *met;             /* [built]: MET, or AT_HAND */
    double rounds, low[3], high[3]; /* of the shell at hand (m); its box */
};

/* The faces that follow each other from one on, all of them. Returns 0 when some edge is free, or
 * a front looks inside where its neighbour's looks outside. */
static int follow(struct shells_walk *w, uint32_t from)
{
    int closed = 1;
    w->faces[0] = from;
    w->count = 1;
    w->met[from] = AT_HAND;
    for (uint32_t at = 0; at < w->count; at++)
        for (int i = 0; i < w->h->elements[w->faces[at]].vertices; i++) {
            const int64_t mate = w->mates->of[w->faces[at]][i];
            if (mate == NO_MATE || mate % 2) {
                closed = 0;
            } else if (!w->met[mate / 2]) {
                w->met[mate / 2] = AT_HAND;
                w->faces[w->count++] = (uint32_t)(mate / 2);
            }
        }
    return closed;
}

/* Is every face flat, and no neighbour of it in front of its plane? */
static int bends_out(const struct shells_walk *w)
{
    for (uint32_t f = 0; f < w->count; f++) {
        const struct element *plane = &w->h->elements[w->faces[f]];
        double high = 0, low = 0, deep = 0;
        element_reach(plane, plane, &high, &low);
        if (high > w->rounds || low < -w->rounds)
            return 0;
        for (int i = 0; i < plane->vertices; i++)
            element_reach(plane, &w->h->elements[w->mates->of[w->faces[f]][i] / 2], &high, &deep);
        if (high > w->rounds)
            return 0;
    }
    return 1;
}

/* Has the shell at hand a corner in front of a plane, of its faces below an element? Boxes and
 * groups that are beside the shell, or boxes behind the plane, are not looked into: a plane of a
 * ball meets few, and tops of towers are a group of all of them. */
static int has_in_front(const struct shells_walk *w, const struct element *plane, uint32_t index)
{
    const struct element *e = &w->h->elements[index];
    double high = 0, low = 0, box[2][3];
    if (!e->children) {
        if (w->met[index] == AT_HAND)
            element_reach(plane, e, &high, &low);
        return high > w->rounds;
    }
    element_box(e, box);
    for (int k = 0; k < 3; k++)
        if (box[0][k] > w->high[k] + w->h->flat || box[1][k] < w->low[k] - w->h->flat)
            return 0;
    if (!e->vertices)
        box_reach((const double(*)[3])e->vertex, plane->vertex[0], plane->normal, &high, &low);
    if (!e->vertices && high <= w->rounds / 2) /* rounding of the sum is far less */
        return 0;
    for (uint32_t c = 0; c < e->children; c++)
        if (has_in_front(w, plane, e->child + c))
            return 1;
    return 0;
}

/* Has the shell a corner behind a plane by more than faces reach off theirs? Looked for from the
 * shell's other side on. */
static int has_behind(const struct shells_walk *w, const struct element *plane, uint32_t from)
{
    double high = 0, low = 0;
    for (uint32_t g = 0; g < w->count && !(low < -8 * w->h->flat); g++)
        element_reach(plane, &w->h->elements[w->faces[(from + g) % w->count]], &high, &low);
    return low < -8 * w->h->flat;
}

/* Does no corner lie in front of a plane, and some behind each? Else points in the plane of a plate
 * were inside. */
static int is_convex(const struct shells_walk *w)
{
    for (uint32_t f = 0; f < w->count; f++) {
        const struct element *plane = &w->h->elements[w->faces[f]];
        if (!has_behind(w, plane, f + w->count / 2) || has_in_front(w, plane, 0))
            return 0;
    }
    return 1;
}

/* The box of the shell at hand, and what rounding is in it. */
static void measure(struct shells_walk *w)
{
    double far = 0;
    for (int k = 0; k < 3; k++) {
        w->low[k] = INFINITY;
        w->high[k] = -INFINITY;
    }
    for (uint32_t f = 0; f < w->count; f++) {
        const struct element *e = &w->h->elements[w->faces[f]];
        for (int i = 0; i < e->vertices; i++)
            for (int k = 0; k < 3; k++) {
                w->low[k] = fmin(w->low[k], e->vertex[i][k]);
                w->high[k] = fmax(w->high[k], e->vertex[i][k]);
                far = fmax(far, fabs(e->vertex[i][k]));
            }
    }
    w->rounds = ROUNDS * far;
}

/* Let the faces at hand be some of those that have been. */
static void put_away(const struct shells_walk *w)
{
    for (uint32_t f = 0; f < w->count; f++)
        w->met[w->faces[f]] = MET;
}

/* Clusters and groups whose faces are all of one solid. Returns which; of what has no children, it
 * is known. */
static uint32_t gather(struct solids *s, const struct hierarchy *h, uint32_t index)
{
    const struct element *e = &h->elements[index];
    uint32_t all = 0;
    if (s->of[index] || e->children == 0)
        return s->of[index];
    for (uint32_t c = 0; c < e->children; c++) {
        const uint32_t of = gather(s, h, e->child + c);
        all = c == 0 || of == all ? of : 0;
    }
    return s->of[index] = all;
}

/* The place of a face with this normal; one that is free, if there is none. */
static uint32_t find(const struct solids *s, const struct hierarchy *h, const double n[3])
{
    uint32_t at = (uint32_t)vector_hash(n) & (s->places - 1);
    while (s->by_normal[at] && !vectors_equal(h->elements[s->by_normal[at] - 1].normal, n))
        at = (at + 1) & (s->places - 1);
    return at;
}

/* Of faces with one normal, the first. */
static int keep_normals(struct solids *s, const struct hierarchy *h)
{
    uint32_t faces = 0;
    for (uint32_t i = 0; i < h->built; i++)
        faces += s->of[i] != 0;
    for (s->places = 2; s->places / 2 < faces;)
        s->places *= 2;
    s->by_normal = calloc(s->places, sizeof *s->by_normal);
    if (!s->by_normal)
        return -1;
    for (uint32_t i = 0; i < h->built; i++)
        if (s->of[i]) {
            const uint32_t at = find(s, h, h->elements[i].normal);
            s->by_normal[at] = s->by_normal[at] ? s->by_normal[at] : i + 1;
        }
    return 0;
}

uint32_t solids_behind(const struct solids *s, const struct hierarchy *h, const double n[3],
                       const double (*points)[3], int count, double most)
{
    if (s->count == 0)
        return 0;
    const uint32_t face = s->by_normal[find(s, h, n)];
    if (face == 0)
        return 0;
    for (int i = 0; i < count; i++)
        if (!(height3(points[i], h->elements[face - 1].vertex[0], n) > -most))
            return 0;
    return s->of[face - 1];
}

int solids_open(struct solids *s, const struct hierarchy *h, const struct mates *mates)
{
    const size_t room = (size_t)h->built + 1;
    struct shells_walk w = {.h = h, .mates = mates};
    memset(s, 0, sizeof *s);
    s->of = calloc(room, sizeof *s->of);
    w.faces = malloc(room * sizeof *w.faces);
    w.met = calloc(room, 1);
    int failed = !s->of || !w.faces || !w.met;
    for (uint32_t i = 0; i < h->built && !failed; i++) {
        if (w.met[i] || mates->of[i][0] == NO_MATE)
            continue;
        const int closed = follow(&w, i);
        measure(&w);
        if (closed && bends_out(&w) && is_convex(&w)) {
            s->count++;
            for (uint32_t f = 0; f < w.count; f++)
                s->of[w.faces[f]] = s->count;
        }
        put_away(&w);
    }
    if (!failed && s->count > 0) {
        failed = keep_normals(s, h) < 0;
        (void)gather(s, h, 0);
    }
    free(w.faces);
    free(w.met);
    return failed ? -1 : 0;
}

void solids_close(struct solids *s)
{
    free(s->of);
    free(s->by_normal);
    memset(s, 0, sizeof *s);
}
