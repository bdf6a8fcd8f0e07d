/* bodies.c - convex solids of a few faces.
 *
 * Faces that follow each other across their edges close a shell, or leave edges free that go around
 * sides without a face: a solid that stands on something, as a chair's leg between floor and seat.
 * Where other faces cover such sides wholly they are shut by lids (body_lids.h); what goes in there
 * meets them, so lids change nothing outside. Where no corner of a closed shell lies in front of
 * any of its planes, it is the surface of a convex solid, its fronts outside. So what it hides from
 * a point is one convex polygon, whatever its faces are. Solids are made of what stands in shafts,
 * and then, where faces lie on each other, of any faces (body_parts.h). Invariant: a body has no
 * free edge but its lids', no bent face and no face whose front looks inside; a face is told to be
 * of one body at most, also where a stack is a solid and its boxes are.
 * [a closed surface that each of its planes supports is its hull's; derived here]
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "hierarchy/bodies.h"
#include "hierarchy/body_feet.h"
#include "hierarchy/body_parts.h"
#include "hierarchy/body_rest.h"
#include "hierarchy/places.h"
#include "hierarchy/reach.h"
#include "util/array.h"

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
static int follow(struct shell *s, uint32_t face[BODY_FACES], const struct mates *mates,
                  uint32_t from)
{
    s->face = s->side = face;
    s->faces = 1;
    s->edges = 0;
    face[0] = from;
    for (int at = 0; at < s->faces; at++) {
        const struct element *e = &s->h->elements[face[at]];
        for (int i = 0; i < e->vertices; i++) {
            const int64_t mate = mates->of[face[at]][i];
            int k = 0;
            if (is_free(s->h, e, mate)) {
                s->edge[s->edges++] = (struct free_edge){
                    at, -1, e->vertex[i], e->vertex[i + 1 < e->vertices ? i + 1 : 0]};
                continue;
            }
            while (k < s->faces && face[k] != (uint32_t)(mate / 2))
                k++;
            if (k == BODY_FACES)
                return 0;
            if (k == s->faces)
                face[s->faces++] = (uint32_t)(mate / 2);
        }
    }
    s->sides = s->faces;
    return 1;
}

static int is_convex(const struct shell *s)
{
    for (int i = 0; i < s->sides; i++) {
        const struct element *e = &s->h->elements[s->side[i]];
        if (!body_lids_supports(s, (const double(*)[3])e->vertex, e->vertices, e->normal))
            return 0;
    }
    for (int i = 0; i < s->lids; i++)
        if (!body_lids_supports(s, (const double(*)[3])s->lid[i].corner, s->lid[i].n,
                                s->lid[i].normal))
            return 0;
    return 1;
}

/* The place of a corner among so many, the next one when it is new. Corners are one that faces
 * round apart. */
static int place_of(double (*corners)[3], int count, const double p[3], double flat)
{
    for (int at = 0; at < count; at++) {
        double apart[3];
        sub3(apart, corners[at], p);
        if (length3(apart) <= PLACES_APART * flat)
            return at;
    }
    memcpy(corners[count], p, sizeof corners[count]);
    return count;
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

static void put_lids(struct body *body, struct bodies *b, const struct shell *s)
{
    for (int i = 0; i < s->lids; i++) {
        struct body_lid *lid = &b->lids[body->lid + (uint32_t)i];
        memcpy(lid->n, s->lid[i].normal, sizeof lid->n);
        memcpy(lid->at, s->lid[i].corner[0], sizeof lid->at);
    }
    body->lids = (uint8_t)s->lids;
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
                at[end] = place_of(corners, count, e->vertex[(i + end) % e->vertices], s->h->flat);
                count += at[end] == count;
            }
            edges[body->edges++] = (struct body_edge){(uint8_t)at[0], (uint8_t)at[1],
                                                      (uint8_t)side[f], (uint8_t)right};
        }
    }
    for (int i = 0; i < s->joints; i++) {
        const struct lid_joint *joint = &s->joint[i];
        const int from = place_of(corners, count, joint->from, s->h->flat);
        count += from == count;
        const int to = place_of(corners, count, joint->to, s->h->flat);
        count += to == count;
        edges[body->edges++] =
            (struct body_edge){(uint8_t)from, (uint8_t)to, (uint8_t)(sides + joint->left),
                               (uint8_t)(sides + joint->right)};
    }
    put_lids(body, b, s);
    body->faces = (uint8_t)sides;
    body->corners = (uint8_t)count;
}

/* The same of a shell of parts, which does not stand in shafts: nobody asks for edges, and corners
 * are any. */
static void measure_parts(struct body *body, struct bodies *b, const struct shell *s)
{
    int count = 0;
    memcpy(b->faces + body->face, s->side, (size_t)s->sides * sizeof *s->side);
    for (int f = 0; f < s->faces; f++) {
        const struct element *e = &s->h->elements[s->face[f]];
        for (int i = 0; i < e->vertices && count < BODY_CORNERS; i++)
            count += place_of(b->corners + body->corner, count, e->vertex[i], s->h->flat) == count;
    }
    put_lids(body, b, s);
    body->faces = (uint8_t)s->sides;
    body->corners = (uint8_t)count;
}

/* While they are found. */
struct making {
    struct bodies *bodies;
    uint32_t count;
    struct body next; /* of the lists, empty yet */
    struct body_lining lining;
    size_t room[5];
};

/* Returns 0, or -1 when out of memory. */
static int make_room(struct making *m)
{
    struct bodies *b = m->bodies;
    const struct body *next = &m->next;
    return array_reserve(&b->body, m->count + 1, &m->room[0], sizeof *b->body) < 0
                   || array_reserve(&b->faces, next->face + BODY_FACES, &m->room[1],
                                    sizeof *b->faces)
                          < 0
                   || array_reserve(&b->corners, next->corner + BODY_CORNERS, &m->room[2],
                                    sizeof *b->corners)
                          < 0
                   || array_reserve(&b->edges, next->edge + BODY_EDGES, &m->room[3],
                                    sizeof *b->edges)
                          < 0
                   || array_reserve(&b->lids, next->lid + BODY_LIDS, &m->room[4], sizeof *b->lids)
                          < 0
               ? -1
               : 0;
}

/* An element and all below it are of the body. */
static void mark(struct bodies *b, const struct hierarchy *h, uint32_t index, uint32_t body)
{
    const struct element *e = &h->elements[index];
    b->whose[index] = body + 1;
    for (uint32_t c = 0; c < e->children; c++)
        mark(b, h, e->child + c, body);
}

/* Does a lid lie in the plane of a side, and on something that looks the other way? Then it stands
 * for what there is of that side, in parts that are not of the shell, where these are covered. */
static int is_patched(const struct shell *s)
{
    for (int i = 0; i < s->lids; i++)
        for (int k = 0; k < s->sides; k++) {
            const struct element *e = &s->h->elements[s->side[k]];
            double high = 0, low = 0;
            polygon_reach((const double(*)[3])s->lid[i].corner, (uint32_t)s->lid[i].n, e->vertex[0],
                          e->normal, &high, &low);
            if (low >= -s->h->flat && dot3(e->normal, s->lid[i].normal) > 0
                && body_rest_on_lid(s->h, &s->lid[i]))
                return 1;
        }
    return 0;
}

/* Is a shell the surface of a convex solid, with what it stands on? */
static int is_solid(struct shell *s)
{
    return body_lids_find(s) && !is_patched(s) && is_convex(s) && body_feet_shut(s);
}

/* A shell makes the next body. Returns 0, or -1 when out of memory. */
static int add_body(struct making *m, const struct shell *s, const struct mates *mates)
{
    struct bodies *b = m->bodies;
    if (make_room(m) < 0)
        return -1;
    if (mates)
        measure(&m->next, b, s, mates);
    else
        measure_parts(&m->next, b, s);
    for (int k = 0; k < s->faces; k++)
        if (!b->whose[s->face[k]])
            mark(b, s->h, s->face[k], m->count);
    if (body_feet_add(b, s, &m->lining, m->count) < 0)
        return -1;
    const struct body made = b->body[m->count++] = m->next;
    m->next = (struct body){.face = made.face + made.faces,
                            .corner = made.corner + made.corners,
                            .edge = made.edge + made.edges,
                            .lid = made.lid + made.lids};
    return 0;
}

/* Those of what h says is solid, and of no body yet. Returns 0, or -1 when out of memory. */
static int find(struct making *m, const struct hierarchy *h, const struct mates *mates)
{
    struct shell shell = {.h = h};
    uint32_t face[BODY_FACES];
    for (uint32_t i = 0; i < h->built; i++)
        if (!m->bodies->whose[i] && h->solid[i] && follow(&shell, face, mates, i)
            && is_solid(&shell) && add_body(m, &shell, mates) < 0)
            return -1;
    return 0;
}

/* Bodies whose sides are in groups with others', as those of boxes that stand flush are, part by
 * part (body_parts.h). They stand on what they do; but what is in shafts is not of them. */
static int find_by_parts(struct making *m, const struct hierarchy *h)
{
    struct body_parts parts;
    struct shell shell = {.h = h};
    int more = body_parts_open(&parts, h, m->bodies->whose);
    if (more == 0)
        more = body_parts_next(&parts, &shell);
    while (more > 0)
        more = is_solid(&shell) && add_body(m, &shell, NULL) < 0 ? -1
                                                                 : body_parts_next(&parts, &shell);
    m->bodies->loose = parts.start;
    m->bodies->loose_count = parts.starts;
    parts.start = NULL;
    body_parts_close(&parts);
    return more;
}

static int find_all(struct making *m, const struct hierarchy *h, const struct mates *mates)
{
    struct bodies *b = m->bodies;
    if (body_lining_open(&m->lining, h) < 0 || find(m, h, mates) < 0)
        return -1;
    for (uint32_t i = 0; i < h->built; i++)
        b->of[i] = h->solid[i] ? b->whose[i] : 0;
    return find_by_parts(m, h);
}

int bodies_open(struct bodies *b, const struct hierarchy *h, const struct mates *mates)
{
    struct making m = {.bodies = b};
    const size_t elements = (size_t)h->built + 1;
    memset(b, 0, sizeof *b);
    b->of = calloc(elements, sizeof *b->of);
    b->whose = calloc(elements, sizeof *b->whose);
    b->covered = calloc(elements, sizeof *b->covered);
    b->shut = calloc(elements, sizeof *b->shut);
    const int ready = b->of && b->whose && b->covered && b->shut,
              status = ready ? find_all(&m, h, mates) : -1;
    body_lining_close(&m.lining);
    if (status == 0)
        body_feet_sum(b, h);
    return status;
}

void bodies_close(struct bodies *b)
{
    free(b->of);
    free(b->whose);
    free(b->covered);
    free(b->shut);
    free(b->feet);
    free(b->loose);
    free(b->body);
    free(b->faces);
    free(b->corners);
    free(b->edges);
    free(b->lids);
    memset(b, 0, sizeof *b);
}
