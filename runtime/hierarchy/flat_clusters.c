/* flat_clusters.c - see flat_clusters.h.
 *
 * What a plane says of a face in it, as whether it stands in a shaft that runs on one side, it says
 * of all faces in it: so a floor of thousands is asked once. Planes of small faces lean by how
 * their corners are rounded; so two are one if they are nowhere in the scene farther apart than
 * FLAT_APART: the difference of their heights is linear, and largest at a corner of the scene's
 * box. What computing a face's normal in another order of its corners would change counts as well.
 * Invariant: nowhere in that box is the plane of a face of a flat cluster farther from the
 * cluster's than that. [Derived here]
 * SPDX-License-Identifier: MIT */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include "hierarchy/children_first.h"
#include "hierarchy/flat_clusters.h"
#include "hierarchy/reach.h"

struct search {
    struct hierarchy *h;
    double extent; /* of the scene (m) */
    double *off;   /* [built]: of planes below an element from its own, at the most (m) */
};

/* How far from each other two planes are anywhere in the scene (m), whichever way they look. */
static double apart(const struct search *s, const struct element *a, const struct element *b)
{
    const double same = dot3(a->normal, b->normal) < 0 ? -1 : 1,
                 over = height3(b->vertex[0], a->vertex[0], a->normal);
    double turn[3], high, low;
    for (int k = 0; k < 3; k++)
        turn[k] = a->normal[k] - same * b->normal[k];
    box_reach((const double(*)[3])s->h->elements[0].vertex, b->vertex[0], turn, &high, &low);
    return fmax(fabs(over + high), fabs(over + low));
}

/* Roundings of a difference of corners, two of which turn a normal, in each of two orders. */
static const double ROUNDINGS = 8 * DBL_EPSILON;

/* A face's own plane, if it is flat and wide enough to tell it. */
static void find_face(const struct search *s, uint32_t index)
{
    const struct element *e = &s->h->elements[index];
    double high = 0, low = 0;
    element_reach(e, e, &high, &low);
    const double off = fmax(high, -low) + ROUNDINGS * s->extent * s->extent * e->radius / e->area;
    if (off <= FLAT_APART * s->extent) {
        s->h->plane[index] = index;
        s->off[index] = off;
    }
}

/* The plane of the first child is the cluster's, if those of the others are. */
static void find_cluster(const void *search, uint32_t index)
{
    const struct search *s = search;
    const struct hierarchy *h = s->h;
    const struct element *e = &h->elements[index];
    const uint32_t plane = e->children ? h->plane[e->child] : 0;
    const double most = FLAT_APART * s->extent;
    double off = 0;
    for (uint32_t c = e->child; c < e->child + e->children && plane && off <= most; c++)
        off = fmax(off, h->plane[c]
                            ? s->off[c] + apart(s, &h->elements[plane], &h->elements[h->plane[c]])
                            : INFINITY);
    if (plane && off <= most) {
        h->plane[index] = plane;
        s->off[index] = off;
    }
}

int flat_clusters_find(struct hierarchy *h)
{
    struct search s = {.h = h};
    s.off = calloc(h->built, sizeof *s.off);
    h->plane = calloc(h->built, sizeof *h->plane);
    if (!s.off || !h->plane) {
        free(s.off);
        return -1;
    }
    for (int k = 0; k < 3; k++)
        s.extent = fmax(s.extent, h->high[k] - h->low[k]);
    for (uint32_t i = 0; i < h->face_count; i++)
        find_face(&s, h->face_element[i]);
    children_first_clusters(h, find_cluster, &s);
    free(s.off);
    return 0;
}
