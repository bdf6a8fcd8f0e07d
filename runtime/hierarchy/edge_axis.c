/* edge_axis.c - see edge_axis.h.
 * SPDX-License-Identifier: MIT */
#include "hierarchy/edge_axis.h"

#include <math.h>

#include "geometry.h"
#include "kernel/constants.h"

int edge_axis_of(struct edge_axis *x, const struct hierarchy *h, const struct edge *edge,
                 size_t shared, double precision)
{
    const struct element *e = hierarchy_surface(h, edge->face);
    double largest = 0;
    for (int k = 0; k < 3; k++)
        largest = fmax(largest, fmax(fabs(edge->end[0][k]), fabs(edge->end[1][k])));
    *x = (struct edge_axis){.h = h, .edge = edge, .shared = shared};
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
static struct wing wing_of(const struct edge_axis *x, uint32_t face, const double direction[3],
                           int whole)
{
    double over[3];
    cross3(over, x->along, direction);
    const uint32_t behind = dot3(over, hierarchy_surface(x->h, face)->normal) > 0;
    return (struct wing){atan2(dot3(direction, x->across.v), dot3(direction, x->across.u)),
                         2 * face + 1 - behind, 2 * face + behind, whole};
}

void edge_axis_inwards(const struct edge_axis *x, uint32_t face, double direction[3])
{
    sub3(direction, hierarchy_surface(x->h, face)->centre, x->edge->end[0]);
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

static int is_long(const struct edge_axis *x, const struct stretch *s)
{
    return (s->to - s->from) * x->length > 4 * x->touch;
}

/* The part of the edge that is nearer than touch to a face. Returns 0 where that is no more than
 * where it passes through. */
static int touches(const struct edge_axis *x, uint32_t face, struct stretch *s)
{
    const struct element *e = hierarchy_surface(x->h, face);
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
 * then; EDGE_FACES: perhaps more. */
static int collect(const struct edge_axis *x, uint32_t index, struct stretch *list, int count)
{
    const struct element *e = &x->h->elements[index];
    if (e->vertices) {
        if (count < EDGE_FACES && !x->h->faces[e->face].back)
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

int edge_axis_touched(const struct edge_axis *x, struct stretch *list)
{
    return collect(x, 0, list, 0);
}

int edge_axis_wings(const struct edge_axis *x, uint32_t face, const double p[3], struct wing *wings)
{
    const struct element *e = hierarchy_surface(x->h, face);
    double nearest = INFINITY, direction[3];
    for (int i = 0; i < e->vertices; i++)
        nearest = fmin(nearest, inside_border(e, i, p));
    if (nearest <= x->touch) {
        edge_axis_inwards(x, face, direction);
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
