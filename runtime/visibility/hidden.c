/* hidden.c - is all light in a shaft stopped by faces that share edges?
 *
 * No triangle of a curved mesh hides much, the mesh does. Let every face that meets the shaft have
 * the ends strictly on either side of its plane, and every edge of such a face that meets it be
 * shared with one other, which both ends see from the same side of the surface. Then how many faces
 * a ray between the ends crosses is the same for all of them: it changes only where the ray runs
 * across an edge that is nobody else's, or along which the surface folds over as seen, or where one
 * of the ray's ends passes through a face. So one ray speaks for all; corners that rays meet are a
 * set of too few dimensions to part them. Shells need not be convex, nor closed outside the shaft.
 * Fails (not known): outlines in the shaft, bent faces, corners in the middle of a neighbour's
 * edge. [derived here]
 * SPDX-License-Identifier: MIT */
#include "visibility/hidden.h"
#include "kernel/shaft.h"

int hidden_front(const struct shaft *shaft, const struct element *e)
{
    /* more than what candidates.c may pass over for a strip: offset and a part of it */
    const double clear = shaft->margin + 4 * shaft->reach;
    int first = height3(shaft->end[0][0], e->vertex[0], e->normal) > 0 ? 1 : -1;
    for (int end = 0; end < 2; end++)
        for (int i = 0; i < shaft->points[end]; i++)
            if (!(height3(shaft->end[end][i], e->vertex[0], e->normal) * (end ? -first : first)
                  > clear))
                return 0;
    return hidden_bent(e, shaft->flat) ? 0 : first;
}

int hidden_bent(const struct element *e, double flat)
{
    for (int i = 3; i < e->vertices; i++)
        if (fabs(height3(e->vertex[i], e->vertex[0], e->normal)) > flat)
            return 1;
    return 0;
}

int hidden_edge(const struct shaft *shaft, const double a[3], const double b[3])
{
    return shaft_planes_reach(lanes_width(), shaft, shaft->slack + shaft->grow, a, b);
}

void hidden_middle(const struct shaft *shaft, double ray[2][3])
{
    for (int end = 0; end < 2; end++)
        for (int k = 0; k < 3; k++) {
            ray[end][k] = 0;
            for (int i = 0; i < shaft->points[end]; i++)
                ray[end][k] += shaft->end[end][i][k] / shaft->points[end];
        }
}

void hidden_start(struct hidden *c, const struct hierarchy *h, const struct mates *mates,
                  const struct shaft *shaft)
{
    *c = (struct hidden){h, mates, shaft, {{0}}, 0, 0};
    hidden_middle(shaft, c->ray);
}

void hidden_add(struct hidden *c, uint32_t index)
{
    const struct element *e = &c->h->elements[index];
    int front = c->open ? 0 : hidden_front(c->shaft, e);
    double along[3];
    c->open |= front == 0;
    for (int i = 0; i < e->vertices && !c->open; i++) {
        int64_t mate = c->mates->of[index][i];
        c->open = hidden_edge(c->shaft, e->vertex[i], e->vertex[i + 1 < e->vertices ? i + 1 : 0])
                  && (mate == NO_MATE
                      || hidden_front(c->shaft, &c->h->elements[mate / 2])
                             != (mate % 2 ? -front : front));
    }
    sub3(along, c->ray[1], c->ray[0]);
    c->met |=
        !c->open && hidden_through(c->ray[0], along, (const double(*)[3])e->vertex, e->vertices);
}
