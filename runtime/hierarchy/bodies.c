/* bodies.c - convex solids of a few faces.
 *
 * Faces that follow each other across their edges close a shell, or leave edges free that go around
 * sides without a face: a solid that stands on something, as a chair's leg between floor and seat.
 * Where other faces cover such a side wholly it is shut by a lid; what goes in there meets them, so
 * the lid changes nothing outside. Where no corner of a closed shell lies in front of any of its
 * planes, it is the surface of a convex solid, its fronts outside. So what it hides from a point is
 * one convex polygon, whatever its faces are. Invariant: a face is of one body at most; a body has
 * no free edge but its lids', no bent face and no face whose front looks inside.
 * [a closed surface that each of its planes supports is its hull's; derived here]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "hierarchy/bodies.h"
#include "hierarchy/lids.h"
#include "hierarchy/reach.h"
#include "kernel/constants.h"
#include "util/array.h"

static const uint32_t NO_FACE = UINT32_MAX;

/* An edge that nobody of the shell is across: of a face, from its corner to the next one. */
struct free_edge {
    int face, lid; /* -1: of none yet */
    const double *from, *to;
};

/* A body in the making. */
struct shell {
    const struct hierarchy *h;
    int faces, edges, lids;
    uint32_t face[BODY_FACES];
    struct free_edge edge[BODY_CORNERS];
    struct shell_lid {
        double corner[BODY_CORNERS][3], normal[3], area, around;
        int n;
    } lid[BODY_LIDS];
};

/* Is the mate across an edge not of the same convex solid? Who has its front on another side or
 * stands in front of the face is what the solid stands on. */
static int is_free(const struct hierarchy *h, const struct element *e, int64_t mate)
{
    double high = 0, low = 0;
    if (mate == NO_MATE || mate % 2)
        return 1;
    element_reach(e, &h->elements[mate / 2], &high, &low);
    return high > h->flat;
}

/* The faces that follow each other from one on, and what edges they leave. Returns 0 when there are
 * more than a body has. */
static int follow(struct shell *s, const struct mates *mates, uint32_t from)
{
    s->faces = 1;
    s->edges = s->lids = 0;
    s->face[0] = from;
    for (int at = 0; at < s->faces; at++) {
        const struct element *e = &s->h->elements[s->face[at]];
        for (int i = 0; i < e->vertices; i++) {
            const int64_t mate = mates->of[s->face[at]][i];
            int k = 0;
            if (is_free(s->h, e, mate)) {
                s->edge[s->edges++] = (struct free_edge){
                    at, -1, e->vertex[i], e->vertex[i + 1 < e->vertices ? i + 1 : 0]};
                continue;
            }
            while (k < s->faces && s->face[k] != (uint32_t)(mate / 2))
                k++;
            if (k == BODY_FACES)
                return 0;
            if (k == s->faces)
                s->face[s->faces++] = (uint32_t)(mate / 2);
        }
    }
    return 1;
}

/* The one free edge that begins where another ends, but for rounding; NULL: none does, or more
 * than one. */
static struct free_edge *next_edge(struct shell *s, const struct free_edge *edge)
{
    struct free_edge *next = NULL;
    for (int i = 0; i < s->edges; i++) {
        double apart[3];
        sub3(apart, s->edge[i].from, edge->to);
        if (dot3(apart, apart) > s->h->flat * s->h->flat)
            continue;
        if (next)
            return NULL;
        next = &s->edge[i];
    }
    return next;
}

/* The side that free edges go around from one on, as seen from outside: the other way round than
 * its neighbours go along them. Returns 0 when it is open. */
static int add_lid(struct shell *s, struct free_edge *first)
{
    struct shell_lid *lid = &s->lid[s->lids];
    struct free_edge *edge = first;
    lid->around = 0;
    lid->n = 0;
    do {
        double along[3];
        if (edge->lid >= 0)
            return 0;
        edge->lid = s->lids;
        sub3(along, edge->to, edge->from);
        lid->around += length3(along);
        lid->n++;
        memcpy(lid->corner[BODY_CORNERS - lid->n], edge->to, sizeof lid->corner[0]);
        edge = next_edge(s, edge);
    } while (edge && edge != first);
    memmove(lid->corner, lid->corner + BODY_CORNERS - lid->n, (size_t)lid->n * sizeof *lid->corner);
    lid->area = polygon_normal(lid->corner, (uint32_t)lid->n, lid->normal);
    s->lids++;
    return edge && lid->area > 0;
}

static int find_lids(struct shell *s)
{
    for (int i = 0; i < s->edges; i++)
        if (s->edge[i].lid < 0 && (s->lids == BODY_LIDS || !add_lid(s, &s->edge[i])))
            return 0;
    return 1;
}

/* Is a side flat, and does no corner lie in front of its plane, and some behind by more than
 * rounding? Else points in the plane of a plate were inside. */
static int supports(const struct shell *s, const double (*v)[3], int n, const double normal[3])
{
    double high = 0, low = 0, deepest = 0;
    polygon_reach(v, (uint32_t)n, v[0], normal, &high, &low);
    for (int i = 0; i < s->faces; i++) {
        const struct element *e = &s->h->elements[s->face[i]];
        polygon_reach((const double(*)[3])e->vertex, e->vertices, v[0], normal, &high, &deepest);
    }
    return high <= s->h->flat && low >= -s->h->flat && deepest < -8 * s->h->flat;
}

static int is_convex(const struct shell *s)
{
    for (int i = 0; i < s->faces; i++) {
        const struct element *e = &s->h->elements[s->face[i]];
        if (!supports(s, (const double(*)[3])e->vertex, e->vertices, e->normal))
            return 0;
    }
    for (int i = 0; i < s->lids; i++)
        if (!supports(s, (const double(*)[3])s->lid[i].corner, s->lid[i].n, s->lid[i].normal))
            return 0;
    return 1;
}

/* May faces below an element cover some of a lid? Not where they are elsewhere, or not in its
 * plane: of a group's that is known but for how far its faces reach off it. */
static int is_near(const struct hierarchy *h, const struct element *e, const struct shell_lid *lid)
{
    const double(*v)[3] = (const double(*)[3])lid->corner,
          most = e->children ? 2 * h->flat : h->flat;
    double high = 0, low = 0, box[2][3];
    if (e->vertices) {
        polygon_reach(v, (uint32_t)lid->n, e->vertex[0], e->normal, &high, &low);
        if (!(fabs(dot3(e->normal, lid->normal)) > GROUP_COSINE) || high > most || low < -most)
            return 0;
    }
    for (int k = 0; k < 3; k++) {
        double from = v[0][k], to = from;
        box[0][k] = e->vertices ? e->centre[k] - e->radius : e->vertex[0][k];
        box[1][k] = e->vertices ? e->centre[k] + e->radius : e->vertex[1][k];
        for (int i = 1; i < lid->n; i++) {
            from = v[i][k] < from ? v[i][k] : from;
            to = v[i][k] > to ? v[i][k] : to;
        }
        if (from > box[1][k] + most || to < box[0][k] - most)
            return 0;
    }
    return 1;
}

/* What stands on others: a body of these, with that face of its own, or with a lid. */
struct covering {
    struct bodies *standing; /* NULL: nothing does, only areas are asked */
    uint32_t body, face;
};

/* The body stands on an element's front, on so much of it (m2). Returns 0, or -1 when out of
 * memory. */
static int add_foot(const struct covering *by, uint32_t on, uint32_t solid, double area)
{
    struct bodies *b = by->standing;
    if (array_reserve(&b->feet, b->feet_count + 1, &b->feet_room, sizeof *b->feet) < 0)
        return -1;
    b->feet[b->feet_count++] = (struct body_foot){on, solid, by->body, by->face, area};
    return 0;
}

/* What faces below an element, which is part of `solid`, cover of a lid: those that look the same
 * way as it, and the others (m2). Faces that look one way do not lie on each other (overlaps.h).
 * Returns 0, or -1 when out of memory. */
static int add_cover(const struct hierarchy *h, uint32_t index, uint32_t solid,
                     const struct shell_lid *lid, double cover[2], const struct covering *by)
{
    const struct element *e = &h->elements[index];
    const double(*v)[3] = (const double(*)[3])lid->corner;
    struct lid over;
    if (!is_near(h, e, lid))
        return 0;
    if (h->solid[index])
        solid = index;
    if (e->children && (by->standing || !h->solid[index])) {
        for (uint32_t c = 0; c < e->children; c++)
            if (add_cover(h, e->child + c, solid, lid, cover, by) < 0)
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
    return by->standing && !same && sum > 0 ? add_foot(by, index, solid, sum) : 0;
}

/* Are all lids covered, but for what is narrower than faces may reach off their planes? */
static int is_shut(const struct shell *s)
{
    for (int i = 0; i < s->lids; i++) {
        const struct shell_lid *lid = &s->lid[i];
        const double most = lid->area - s->h->flat * lid->around;
        double cover[2] = {0, 0};
        (void)add_cover(s->h, 0, 0, lid, cover, &(struct covering){0});
        if (!(cover[0] >= most || cover[1] >= most))
            return 0;
    }
    return 1;
}

/* The place of a corner among so many, the next one when it is new. Those that faces round apart
 * are two. */
static int place_of(double (*corners)[3], int count, const double p[3])
{
    int at = 0;
    while (at < count && memcmp(corners[at], p, sizeof corners[at]) != 0)
        at++;
    memcpy(corners[at], p, sizeof corners[at]);
    return at;
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

/* Is all of an element in the solid, or on its surface? */
static int is_within(const struct shell *s, const struct element *e)
{
    for (int side = 0; side < s->faces + s->lids; side++) {
        const struct element *f = side < s->faces ? &s->h->elements[s->face[side]] : NULL;
        const struct shell_lid *lid = f ? NULL : &s->lid[side - s->faces];
        double high = 0, low = 0;
        polygon_reach((const double(*)[3])e->vertex, e->vertices, f ? f->vertex[0] : lid->corner[0],
                      f ? f->normal : lid->normal, &high, &low);
        if (high > s->h->flat)
            return 0;
    }
    return 1;
}

/* Is the solid hollow there, as a house of outer and inner walls in the same planes? Then the face
 * goes on across some edge into the solid, where the inner walls do, or on another of its sides. */
static int is_lining(const struct shell *s, const struct mates *mates, uint32_t solid)
{
    const struct element *e = &s->h->elements[solid];
    for (int i = 0; i < e->vertices; i++) {
        const int64_t mate = mates->of[solid][i];
        double high = 0, low = 0;
        int own = 0;
        if (mate == NO_MATE || mate % 2)
            continue;
        for (int k = 0; k < s->faces; k++)
            own |= s->face[k] == (uint32_t)(mate / 2);
        element_reach(e, &s->h->elements[mate / 2], &high, &low);
        if (!own && (high > s->h->flat || low < -s->h->flat)
            && is_within(s, &s->h->elements[mate / 2]))
            return 1;
    }
    return 0;
}

/* What a body stands on, with its lids and with faces of its own. Returns 0, or -1 when out of
 * memory. */
static int add_feet(struct bodies *b, const struct shell *s, const struct mates *mates,
                    uint32_t body)
{
    const size_t before = b->feet_count;
    double cover[2] = {0, 0};
    int status = 0;
    for (int i = 0; i < s->lids && status == 0; i++) {
        const struct covering by = {b, body, NO_FACE};
        status = add_cover(s->h, 0, 0, &s->lid[i], cover, &by);
    }
    for (int i = 0; i < s->faces && status == 0; i++) {
        const struct element *e = &s->h->elements[s->face[i]];
        const struct covering by = {b, body, s->face[i]};
        struct shell_lid own = {.n = e->vertices};
        memcpy(own.corner, e->vertex, (size_t)e->vertices * sizeof *e->vertex);
        memcpy(own.normal, e->normal, sizeof own.normal);
        status = add_cover(s->h, 0, 0, &own, cover, &by);
    }
    const size_t all = b->feet_count;
    b->feet_count = before;
    for (size_t i = before; i < all; i++)
        if (!is_lining(s, mates, b->feet[i].solid))
            b->feet[b->feet_count++] = b->feet[i];
    return status;
}

static int compare_feet(const void *a, const void *b)
{
    const struct body_foot *x = a, *y = b;
    return x->on != y->on ? (x->on < y->on ? -1 : 1) : (x->body > y->body) - (x->body < y->body);
}

/* Bodies cover what they stand on, and that as much of them; where it is of a body itself, that
 * stands on them in turn and is counted so. */
static void sum_feet(struct bodies *b, const struct hierarchy *h)
{
    for (size_t i = 0; i < b->feet_count; i++) {
        const struct body_foot *foot = &b->feet[i];
        b->covered[foot->on] += foot->area;
        b->shut[foot->on] += foot->face != NO_FACE ? foot->area : 0;
        if (foot->face != NO_FACE && !b->of[foot->solid])
            add_share(b, h, foot->face, foot->area / h->elements[foot->face].area);
    }
    if (b->feet_count)
        qsort(b->feet, b->feet_count, sizeof *b->feet, compare_feet);
}

/* Sides: of each face the first that lies in one plane with it. Returns how many; side[]: which of
 * them a face is of. */
static int find_sides(const struct shell *s, uint32_t *first, int side[BODY_FACES])
{
    int sides = 0;
    for (int f = 0; f < s->faces; f++) {
        const struct element *e = &s->h->elements[s->face[f]];
        int k = 0;
        for (; k < sides; k++) {
            const struct element *plane = &s->h->elements[first[k]];
            double high = 0, low = 0;
            element_reach(plane, e, &high, &low);
            if (high <= s->h->flat && low >= -s->h->flat && dot3(e->normal, plane->normal) > 0)
                break;
        }
        side[f] = k;
        if (k == sides)
            first[sides++] = s->face[f];
    }
    return sides;
}

/* The sides, corners, edges and lids of a body, the last of the lists. Between faces of one side is
 * no edge. */
static void measure(struct body *body, struct bodies *b, const struct shell *s,
                    const struct mates *mates)
{
    double(*corners)[3] = b->corners + body->corner;
    struct body_edge *edges = b->edges + body->edge;
    int count = 0, free = 0, side[BODY_FACES];
    const int sides = find_sides(s, b->faces + body->face, side);
    for (int f = 0; f < s->faces; f++) {
        const struct element *e = &s->h->elements[s->face[f]];
        for (int i = 0; i < e->vertices; i++) {
            const int64_t mate = mates->of[s->face[f]][i];
            int at[2], other = 0, right;
            if (is_free(s->h, e, mate)) {
                right = sides + s->edge[free++].lid;
            } else {
                while (s->face[other] != (uint32_t)(mate / 2))
                    other++;
                if (other < f || side[other] == side[f])
                    continue;
                right = side[other];
            }
            for (int end = 0; end < 2; end++) {
                at[end] = place_of(corners, count, e->vertex[(i + end) % e->vertices]);
                count += at[end] == count;
            }
            edges[body->edges++] = (struct body_edge){(uint8_t)at[0], (uint8_t)at[1],
                                                      (uint8_t)side[f], (uint8_t)right};
        }
    }
    for (int i = 0; i < s->lids; i++) {
        struct body_lid *lid = &b->lids[body->lid + (uint32_t)i];
        memcpy(lid->n, s->lid[i].normal, sizeof lid->n);
        memcpy(lid->at, s->lid[i].corner[0], sizeof lid->at);
    }
    body->faces = (uint8_t)sides;
    body->corners = (uint8_t)count;
    body->lids = (uint8_t)s->lids;
}

/* The next body of the lists, empty yet. Returns 0, or -1 when out of memory. */
static int make_room(struct bodies *b, uint32_t count, const struct body *next, size_t room[5])
{
    return array_reserve(&b->body, count + 1, &room[0], sizeof *b->body) < 0
                   || array_reserve(&b->faces, next->face + BODY_FACES, &room[1], sizeof *b->faces)
                          < 0
                   || array_reserve(&b->corners, next->corner + BODY_CORNERS, &room[2],
                                    sizeof *b->corners)
                          < 0
                   || array_reserve(&b->edges, next->edge + BODY_EDGES, &room[3], sizeof *b->edges)
                          < 0
                   || array_reserve(&b->lids, next->lid + BODY_LIDS, &room[4], sizeof *b->lids) < 0
               ? -1
               : 0;
}

int bodies_open(struct bodies *b, const struct hierarchy *h, const struct mates *mates)
{
    struct shell shell = {.h = h};
    uint32_t count = 0;
    size_t room[5] = {0};
    struct body next = {0};
    memset(b, 0, sizeof *b);
    b->of = calloc((size_t)h->built + 1, sizeof *b->of);
    b->covered = calloc((size_t)h->built + 1, sizeof *b->covered);
    b->shut = calloc((size_t)h->built + 1, sizeof *b->shut);
    if (!b->of || !b->covered || !b->shut)
        return -1;
    for (uint32_t i = 0; i < h->built; i++) {
        if (b->of[i] || !h->solid[i] || !follow(&shell, mates, i) || !find_lids(&shell)
            || !is_convex(&shell) || !is_shut(&shell))
            continue;
        if (make_room(b, count, &next, room) < 0)
            return -1;
        measure(&next, b, &shell, mates);
        if (add_feet(b, &shell, mates, count) < 0)
            return -1;
        b->body[count++] = next;
        for (int k = 0; k < shell.faces; k++)
            b->of[shell.face[k]] = count;
        next = (struct body){next.face + next.faces,
                             next.corner + next.corners,
                             next.edge + next.edges,
                             next.lid + next.lids,
                             0,
                             0,
                             0,
                             0};
    }
    sum_feet(b, h);
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

/* Does no side part an element from a body by more than that, and does it not look away where it
 * lies on one? */
static int is_joined(const struct bodies *b, const struct hierarchy *h, const struct body *body,
                     const struct element *e, double near)
{
    const double *at, *n;
    int joined = 1;
    for (uint32_t i = 0; i < (uint32_t)body->faces + body->lids && joined; i++) {
        double high = -INFINITY, low = INFINITY;
        side_of(b, h, body, i, &at, &n);
        polygon_reach((const double(*)[3])e->vertex, e->vertices, at, n, &high, &low);
        joined = low < -near || (low <= near && dot3(e->normal, n) < 0);
    }
    return joined;
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
        if (b->feet[i].face != NO_FACE && holds(b, h, &b->body[b->feet[i].body], p))
            return 1;
    return 0;
}

int bodies_join(const struct bodies *b, const struct hierarchy *h, uint32_t element,
                const struct element *other, double near)
{
    for (size_t i = first_foot(b, element); i < b->feet_count && b->feet[i].on == element; i++)
        if (b->feet[i].face != NO_FACE && is_joined(b, h, &b->body[b->feet[i].body], other, near))
            return 1;
    return 0;
}

void bodies_close(struct bodies *b)
{
    free(b->of);
    free(b->covered);
    free(b->shut);
    free(b->feet);
    free(b->body);
    free(b->faces);
    free(b->corners);
    free(b->edges);
    free(b->lids);
    memset(b, 0, sizeof *b);
}
