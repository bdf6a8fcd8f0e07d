/* body_feet.c - see body_feet.h.
 *
 * A body stands on a face whose front looks into it where one of its sides, or a lid, lies on that.
 * There the face is covered. Where the side is a face of its own, light from the covered part ends
 * at it, and so does light that would come there through the body; behind a lid is nothing, but for
 * that of an open one, as a pipe from floor to ceiling. Faces that go on into the body, or along
 * others of its sides, and nowhere out of it line a hollow one, which stands on nothing there.
 * Invariant: once summed up, feet are in the order of what they stand on, then of bodies.
 * [derived here]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "hierarchy/body_feet.h"
#include "hierarchy/body_rest.h"
#include "hierarchy/lids.h"
#include "hierarchy/reach.h"
#include "util/array.h"

static const uint32_t NO_FACE = UINT32_MAX;

/* What stands on others: a body of these, with that face of its own, or with a lid. */
struct covering {
    struct bodies *standing; /* NULL: nothing does, only areas are asked */
    uint32_t body, face;
};

/* The body stands on an element's front, on so much of it (m2). Returns 0, or -1 when out of
 * memory. */
static int add_foot(const struct covering *by, uint32_t on, double area)
{
    struct bodies *b = by->standing;
    if (array_reserve(&b->feet, b->feet_count + 1, &b->feet_room, sizeof *b->feet) < 0)
        return -1;
    b->feet[b->feet_count++] = (struct body_foot){on, by->body, by->face, area};
    return 0;
}

static int is_part(const struct hierarchy *h, uint32_t face, uint32_t of)
{
    return h->range[of].from <= h->range[face].from && h->range[face].to <= h->range[of].to;
}

/* Is a face the other side of one of a side of the body? It is no more behind that than the side
 * itself is. */
static int is_other_side(const struct hierarchy *h, uint32_t index, uint32_t side)
{
    const uint32_t other = face_other_side(h->faces, h->face_count, h->elements[index].face);
    return other != UINT32_MAX && side != NO_FACE && is_part(h, h->face_element[other], side);
}

/* What faces below an element cover of a lid: those that look the same way as it, and the others
 * (m2). Faces that look one way do not lie on each other (overlaps.h). Returns 0, or -1 when out of
 * memory. */
static int add_cover(const struct hierarchy *h, uint32_t index, const struct shell_lid *lid,
                     double cover[2], const struct covering *by)
{
    const struct element *e = &h->elements[index];
    const double(*v)[3] = (const double(*)[3])lid->corner;
    struct lid over;
    if (!body_rest_near(h, e, lid))
        return 0;
    if (e->children && (by->standing || !h->solid[index])) {
        for (uint32_t c = 0; c < e->children; c++)
            if (add_cover(h, e->child + c, lid, cover, by) < 0)
                return -1;
        return 0;
    }
    const int same = dot3(e->normal, lid->normal) > 0;
    double sum = 0;
    lid_of(&over, (const double(*)[3])e->vertex, e->vertices, lid->normal, h->flat);
    for (int i = 2; i < lid->n; i++) {
        double part[3][3];
        memcpy(part[0], v[0], sizeof part[0]);
        memcpy(part[1], v[i - 1], 2 * sizeof part[0]);
        sum += lid_area(&over, (const double(*)[3])part, 3, lid->normal);
    }
    cover[same] += sum;
    return by->standing && !same && sum > 0 && !is_other_side(h, index, by->face)
               ? add_foot(by, index, sum)
               : 0;
}

int body_feet_shut(const struct shell *s)
{
    for (int i = 0; i < s->lids; i++) {
        const struct shell_lid *lid = &s->lid[i];
        const double most = lid->area - s->h->flat * lid->around;
        double cover[2] = {0, 0};
        (void)add_cover(s->h, 0, lid, cover, &(struct covering){0});
        if (!(cover[0] >= most || cover[1] >= most))
            return 0;
    }
    return 1;
}

/* That share of all faces below an element is covered. */
static void add_share(struct bodies *b, const struct hierarchy *h, uint32_t index, double share)
{
    const struct element *e = &h->elements[index];
    if (!e->children) {
        b->covered[index] += share * e->area;
        b->shut[index] += share * e->area;
    }
    for (uint32_t c = 0; c < e->children; c++)
        add_share(b, h, e->child + c, share);
}

/* Is it open where it stands: a pipe from floor to ceiling, a box without two of its sides in a
 * corner, or anything of faces that have another side? Then light gets to what is behind its lids.
 */
static int is_open(const struct shell *s)
{
    const struct hierarchy *h = s->h;
    for (int k = 0; k < s->faces; k++)
        for (uint32_t p = h->range[s->face[k]].from; p < h->range[s->face[k]].to; p++)
            if (face_other_side(h->faces, h->face_count, h->order[p]) != UINT32_MAX)
                return 1;
    return s->lids > 1;
}

/* Are faces around a lid marked as the body's? Else it stands there with another body. */
static int has_lid(const struct bodies *b, const struct shell *s, int lid, uint32_t body)
{
    int own = 0;
    for (int i = 0; i < s->edges; i++)
        own |= s->edge[i].lid == lid && b->whose[s->face[s->edge[i].face]] == body + 1;
    return own;
}

int body_feet_add(struct bodies *b, const struct shell *s, struct body_lining *lining,
                  uint32_t body)
{
    const size_t before = b->feet_count;
    double cover[2] = {0, 0};
    int status = 0;
    const int open = is_open(s);
    for (int i = 0; i < s->lids && !open && status == 0; i++) {
        const struct covering by = {b, body, NO_FACE};
        if (has_lid(b, s, i, body))
            status = add_cover(s->h, 0, &s->lid[i], cover, &by);
    }
    for (int i = 0; i < s->faces && status == 0; i++) {
        const struct element *e = &s->h->elements[s->face[i]];
        if (b->whose[s->face[i]] != body + 1)
            continue;
        const struct covering by = {b, body, s->face[i]};
        struct shell_lid own;
        shell_lid_of(&own, e);
        status = add_cover(s->h, 0, &own, cover, &by);
    }
    const size_t all = b->feet_count;
    b->feet_count = before;
    for (size_t i = before; i < all && status == 0; i++) {
        const int lines = body_lining_is(lining, s, b->whose, body, b->feet[i].on);
        status = lines < 0 ? -1 : 0;
        b->feet[b->feet_count] = b->feet[i];
        b->feet[b->feet_count++].area *= lines > 0 ? 0 : 1;
    }
    return status;
}

static int compare_feet(const void *a, const void *b)
{
    const struct body_foot *x = a, *y = b;
    return x->on != y->on ? (x->on < y->on ? -1 : 1) : (x->body > y->body) - (x->body < y->body);
}

static void sort_feet(struct bodies *b)
{
    if (b->feet_count)
        qsort(b->feet, b->feet_count, sizeof *b->feet, compare_feet);
}

/* Bodies cover what they stand on, and that as much of them; where it is of a body itself, that
 * stands on them in turn and is counted so. */
void body_feet_sum(struct bodies *b, const struct hierarchy *h)
{
    for (size_t i = 0; i < b->feet_count; i++) {
        const struct body_foot *foot = &b->feet[i];
        b->covered[foot->on] += foot->area;
        b->shut[foot->on] += foot->face != NO_FACE ? foot->area : 0;
        if (foot->face != NO_FACE && !b->whose[foot->on])
            add_share(b, h, foot->face, foot->area / h->elements[foot->face].area);
    }
    sort_feet(b);
}

/* A foot of what is no body, unless a body's own account has it. */
static int add_contact(struct bodies *b, uint32_t on, uint32_t face, double area)
{
    if (b->whose[face])
        return 0; /* bodies_hold asks the body */
    if (!b->whose[on]) {
        b->covered[on] += area;
        b->shut[on] += area;
    }
    return add_foot(&(struct covering){b, BODY_NONE, face}, on, area);
}

int body_feet_contacts(struct bodies *b, const struct body_contact *list, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (list[i].solid
            && (add_contact(b, list[i].face[0], list[i].face[1], list[i].area) < 0
                || add_contact(b, list[i].face[1], list[i].face[0], list[i].area) < 0))
            return -1;
    sort_feet(b);
    return 0;
}

/* Corner and normal of a side of a body, lids last. */
static void side_of(const struct bodies *b, const struct hierarchy *h, const struct body *body,
                    uint32_t side, const double **at, const double **n)
{
    if (side < body->faces) {
        const struct element *e = &h->elements[b->faces[body->face + side]];
        *at = e->vertex[0];
        *n = e->normal;
    } else {
        const struct body_lid *lid = &b->lids[body->lid + side - body->faces];
        *at = lid->at;
        *n = lid->n;
    }
}

static int holds(const struct bodies *b, const struct hierarchy *h, const struct body *body,
                 const double p[3])
{
    const double *at, *n;
    int inside = 1;
    for (uint32_t i = 0; i < (uint32_t)body->faces + body->lids && inside; i++) {
        side_of(b, h, body, i, &at, &n);
        inside = height3(p, at, n) < 0;
    }
    return inside;
}

/* Does a plane not part an element from what is behind it by more than that, and does it not look
 * away where it lies on it? */
static int is_within(const struct element *e, const double at[3], const double n[3], double near)
{
    double high = -INFINITY, low = INFINITY;
    polygon_reach((const double(*)[3])e->vertex, e->vertices, at, n, &high, &low);
    return low < -near || (low <= near && dot3(e->normal, n) < 0);
}

/* Does no side part an element from a body? */
static int is_joined(const struct bodies *b, const struct hierarchy *h, const struct body *body,
                     const struct element *e, double near)
{
    const double *at, *n;
    int joined = 1;
    for (uint32_t i = 0; i < (uint32_t)body->faces + body->lids && joined; i++) {
        side_of(b, h, body, i, &at, &n);
        joined = is_within(e, at, n, near);
    }
    return joined;
}

/* Does no plane upright on an edge of a foot part an element from what is over that? */
static int is_over(const struct element *foot, const struct element *e, double near)
{
    int over = 1;
    for (int i = 0; i < foot->vertices && over; i++) {
        double edge[3], out[3];
        sub3(edge, foot->vertex[i + 1 < foot->vertices ? i + 1 : 0], foot->vertex[i]);
        cross3(out, edge, foot->normal);
        const double size = length3(out);
        for (int k = 0; k < 3 && size > 0; k++)
            out[k] /= size;
        over = is_within(e, foot->vertex[i], out, near);
    }
    return over;
}

/* Does a face lie over a point that is in its plane, or near it? */
static int lies_over(const struct element *e, const double p[3])
{
    int over = 1;
    for (int i = 0; i < e->vertices && over; i++) {
        double edge[3], inwards[3];
        sub3(edge, e->vertex[i + 1 < e->vertices ? i + 1 : 0], e->vertex[i]);
        cross3(inwards, e->normal, edge);
        over = height3(p, e->vertex[i], inwards) > 0;
    }
    return over;
}

/* Does it stand there, with a face? */
static int stands(const struct body_foot *foot)
{
    return foot->face != NO_FACE && foot->area > 0;
}

/* The first of the bodies that stand on an element, or where it would be. */
static size_t first_foot(const struct bodies *b, uint32_t element)
{
    size_t low = 0, high = b->feet_count;
    while (low < high) {
        const size_t middle = (low + high) / 2;
        if (b->feet[middle].on < element)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

int bodies_hold(const struct bodies *b, const struct hierarchy *h, uint32_t element,
                const double p[3])
{
    for (size_t i = first_foot(b, element); i < b->feet_count && b->feet[i].on == element; i++)
        if (stands(&b->feet[i])
            && (b->feet[i].body == BODY_NONE ? lies_over(&h->elements[b->feet[i].face], p)
                                             : holds(b, h, &b->body[b->feet[i].body], p)))
            return 1;
    return 0;
}

/* Does something solid that is no body touch it? */
static int is_touched(const struct bodies *b, uint32_t element)
{
    size_t i = first_foot(b, element);
    while (i < b->feet_count && b->feet[i].on == element && b->feet[i].body != BODY_NONE)
        i++;
    return i < b->feet_count && b->feet[i].on == element;
}

int bodies_join(const struct bodies *b, const struct hierarchy *h, uint32_t element,
                const struct element *other, double near)
{
    for (size_t i = first_foot(b, element); i < b->feet_count && b->feet[i].on == element; i++)
        if (stands(&b->feet[i])
            && (b->feet[i].body == BODY_NONE
                    ? is_touched(b, h->face_element[other->face])
                          || is_over(&h->elements[b->feet[i].face], other, near)
                    : is_joined(b, h, &b->body[b->feet[i].body], other, near)))
            return 1;
    return 0;
}

/* Does a face that is part of another lie on an element? */
static int lies_on(const struct bodies *b, const struct hierarchy *h, uint32_t face, uint32_t on)
{
    for (size_t i = first_foot(b, on); i < b->feet_count && b->feet[i].on == on; i++)
        if (b->feet[i].face != NO_FACE && is_part(h, face, b->feet[i].face))
            return 1;
    return 0;
}

int bodies_meet(const struct bodies *b, const struct hierarchy *h, uint32_t one, uint32_t other)
{
    return b->feet_count > 0 && dot3(h->elements[one].normal, h->elements[other].normal) < 0
           && (lies_on(b, h, one, other) || lies_on(b, h, other, one));
}
