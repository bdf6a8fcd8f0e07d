/* across.c - see across.h.
 *
 * All faces with an edge along some of this one are looked for, and this one is parted where theirs
 * end. Along a stretch, as one turns from the face around the edge, through what is behind it, the
 * first that comes with its back ahead is the mate: between the two is a solid. Where a solid
 * begins before one has ended, nothing is known. What is one place, and faces that stand at one
 * angle, is as coarse as groups' faces reach out of their planes (places.h). Mates need not be
 * mutual. [mates.c for edges that are not equal]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>
#include "hierarchy/across.h"
#include "hierarchy/places.h"
#include "kernel/lambert.h"

/* Angles that are one, but for faces that reach out of their planes: as in mates.c. */
static const double TURN_SAME = 1e-6;

/* A face that touches the edge, from there to there (m along it), at an angle behind the own face
 * that is known but for so much. Where it comes with its back ahead a solid ends. */
struct touch {
    double from, to, angle, slack;
    const double *corner[2]; /* that are at these ends */
    uint32_t face;
    int ends;
};

struct search {
    const struct hierarchy *h;
    uint32_t own;
    const double *at, *end; /* of the edge */
    double near, length, along[3], inwards[3], slack;
    struct touch touch[ACROSS_FACES];
    int count;
};

/* The direction of an edge of a face, that from it into the face, and the angle by which the face
 * may reach out of its plane. Returns the edge's length. */
static double frame_of(const struct hierarchy *h, const struct element *e, int side,
                       double along[3], double inwards[3], double *slack)
{
    const double *at = e->vertex[side];
    double wide = 0;
    sub3(along, e->vertex[side + 1 < e->vertices ? side + 1 : 0], at);
    const double length = length3(along);
    for (int k = 0; k < 3; k++)
        along[k] /= length > 0 ? length : 1;
    cross3(inwards, e->normal, along);
    for (int i = 0; i < e->vertices; i++)
        wide = fmax(wide, height3(e->vertex[i], at, inwards));
    *slack = TURN_SAME + h->flat / fmax(wide, h->flat);
    return length;
}

/* Is a point that near to a line? */
static int is_on(const double p[3], const double at[3], const double along[3], double near)
{
    double apart[3], off[3];
    sub3(apart, p, at);
    cross3(off, apart, along);
    return dot3(off, off) <= near * near;
}

/* Add a face by one of its edges, if that is along the own one. */
static void add_touch(struct search *s, uint32_t index, int side)
{
    const struct element *own = &s->h->elements[s->own], *e = &s->h->elements[index];
    const double *from = e->vertex[side], *to = e->vertex[side + 1 < e->vertices ? side + 1 : 0];
    double along[3], inwards[3], slack;
    double t[2] = {height3(from, s->at, s->along), height3(to, s->at, s->along)};
    const int ends = t[0] > t[1];
    struct touch *touch = &s->touch[s->count];
    touch->corner[ends] = from;
    touch->corner[!ends] = to;
    touch->from = fmax(t[ends], 0);
    touch->to = fmin(t[!ends], s->length);
    if (!(touch->to - touch->from > s->near))
        return;
    const double length = frame_of(s->h, e, side, along, inwards, &slack);
    /* off the longer one's line: that of a short edge leads astray */
    if (length > s->length
            ? !is_on(s->at, from, along, s->near) || !is_on(s->end, from, along, s->near)
            : !is_on(from, s->at, s->along, s->near) || !is_on(to, s->at, s->along, s->near))
        return;
    touch->face = index;
    touch->ends = ends;
    touch->slack = slack + s->slack;
    touch->angle = atan2(-dot3(inwards, own->normal), dot3(inwards, s->inwards));
    if (touch->angle < (ends ? touch->slack : -touch->slack))
        touch->angle += 2 * LAMBERT_PI;
    s->count++;
}

/* Does a sphere reach the edge? */
static int is_reached(const struct search *s, const double centre[3], double radius)
{
    double apart[3];
    const double t = fmin(fmax(height3(centre, s->at, s->along), 0), s->length);
    for (int k = 0; k < 3; k++)
        apart[k] = centre[k] - s->at[k] - t * s->along[k];
    return dot3(apart, apart) <= (radius + s->near) * (radius + s->near);
}

static int is_in_box(const struct search *s, const double (*box)[3])
{
    for (int k = 0; k < 3; k++)
        if (fmax(s->at[k], s->end[k]) < box[0][k] - s->near
            || fmin(s->at[k], s->end[k]) > box[1][k] + s->near)
            return 0;
    return 1;
}

static void look_below(struct search *s, uint32_t index)
{
    const struct element *e = &s->h->elements[index];
    if (e->vertices ? !is_reached(s, e->centre, e->radius)
                    : !is_in_box(s, (const double(*)[3])e->vertex))
        return;
    for (uint32_t c = 0; c < e->children && s->count < ACROSS_FACES; c++)
        look_below(s, e->child + c);
    if (e->children || index == s->own || s->h->faces[s->h->order[s->h->range[index].from]].back)
        return;
    for (int side = 0; side < e->vertices && s->count < ACROSS_FACES; side++)
        add_touch(s, index, side);
}

/* Who ends the solid that begins at the own face, there. */
static uint32_t mate_at(const struct search *s, double t)
{
    const struct touch *mate = NULL;
    for (int i = 0; i < s->count; i++) {
        const struct touch *touch = &s->touch[i];
        if (touch->ends && touch->from < t && t < touch->to
            && (!mate || touch->angle < mate->angle))
            mate = touch;
    }
    for (int i = 0; i < s->count && mate; i++) {
        const struct touch *touch = &s->touch[i];
        if (!touch->ends && touch->from < t && t < touch->to
            && touch->angle + touch->slack + mate->slack < mate->angle)
            return ACROSS_NOBODY;
    }
    return mate ? mate->face : ACROSS_NOBODY;
}

int across_edge(const struct hierarchy *h, uint32_t face, int side,
                struct across list[ACROSS_STRETCHES])
{
    const struct element *e = &h->elements[face];
    struct search s;
    struct {
        double t;
        const double *at;
    } stop[2 * ACROSS_FACES + 2];
    int stops = 0, count = 0;
    s.h = h;
    s.own = face;
    s.count = 0;
    s.near = PLACES_APART * h->flat;
    s.at = e->vertex[side];
    s.end = e->vertex[side + 1 < e->vertices ? side + 1 : 0];
    s.length = frame_of(h, e, side, s.along, s.inwards, &s.slack);
    look_below(&s, 0);
    if (s.count == ACROSS_FACES)
        return 0;
    for (int i = 0; i < 2 * s.count; i++) {
        const struct touch *touch = &s.touch[i / 2];
        const double t = i % 2 ? touch->to : touch->from;
        int at = stops++;
        for (; at > 0 && stop[at - 1].t > t; at--)
            stop[at] = stop[at - 1];
        stop[at].t = t;
        stop[at].at = touch->corner[i % 2];
    }
    const double *from = s.at;
    double begin = 0;
    for (int i = 0; i <= stops; i++) {
        const int last = i == stops || s.length - stop[i].t <= s.near;
        const double t = last ? s.length : stop[i].t;
        if (!last && t - begin <= s.near)
            continue;
        const double *to = last ? s.end : stop[i].at;
        list[count++] = (struct across){mate_at(&s, (begin + t) / 2), from, to};
        from = to;
        begin = t;
        if (last)
            break;
    }
    return count;
}
