/* sight_bodies.c - convex solids in the coordinates of the plane that their shadows are cast on.
 *
 * What many points look past is placed once: corners, planes and edges of each body, side by side,
 * as lanes read them. What is under the plane casts no shadow: edges there are left out, and where
 * a body's faces cross the plane it gets an edge, as if it stood on that, and a face that looks
 * down. Invariant: from any point over the plane the edges between a body's fronts and its backs go
 * around it once. Fails: bodies with more than there is room for, and faces of no body; the list is
 * not placed then. [derived here]
 * SPDX-License-Identifier: MIT */
#include "engine/sight_bodies.h"

static int add_corner(struct sight_bodies *b, const double p[3])
{
    if (b->corners == SIGHT_BODY_CORNERS)
        return -1;
    for (int k = 0; k < 3; k++)
        b->corner[k][b->corners] = p[k];
    return b->corners++;
}

static int add_plane(struct sight_bodies *b, const double plane[4])
{
    if (b->planes == SIGHT_BODY_PLANES)
        return -1;
    for (int k = 0; k < 4; k++)
        b->plane[k][b->planes] = plane[k];
    return b->planes++;
}

/* The plane through a point of a side. */
static int add_plane_of(struct sight_bodies *b, const double at[3], const double n[3],
                        const struct outline_frame *f)
{
    double p[3], plane[4] = {dot3(n, f->u), dot3(n, f->v), dot3(n, f->n), 0};
    sight_in_plane(f, at, p);
    plane[3] = dot3(plane, p);
    return add_plane(b, plane);
}

static int add_edge(struct sight_bodies *b, int from, int to, int left, int right)
{
    if (from < 0 || to < 0 || left < 0 || right < 0 || b->edges == SIGHT_BODY_EDGES)
        return -1;
    for (int k = 0; k < 3; k++) {
        b->end[0][k][b->edges] = b->corner[k][from];
        b->end[1][k][b->edges] = b->corner[k][to];
    }
    b->edge[b->edges++] = (struct sight_body_edge){(int16_t)left, (int16_t)right};
    return 0;
}

/* An edge, unless it is under the plane. */
static int add_upper(struct sight_bodies *b, int from, int to, int left, int right)
{
    return from >= 0 && to >= 0 && b->corner[2][from] < 0 && b->corner[2][to] < 0
               ? 0
               : add_edge(b, from, to, left, right);
}

/* The foot of a face that crosses the plane: what stands on that has an edge there, as if it had a
 * face on the plane that looks down; that one is on its right. corner[n]: the face's. */
static int add_foot(struct sight_bodies *b, const int *corner, int n, int left, int right)
{
    double foot[2][3] = {{0}};
    int ends = 0;
    for (int i = 0; i < n; i++) {
        const int from = corner[i], to = corner[i + 1 < n ? i + 1 : 0];
        const double g = b->corner[2][from], h = b->corner[2][to];
        if ((g > 0) == (h > 0))
            continue;
        for (int k = 0; k < 2; k++)
            foot[h > 0][k] =
                b->corner[k][from] + g / (g - h) * (b->corner[k][to] - b->corner[k][from]);
        ends |= h > 0 ? 2 : 1;
    }
    if (ends != 3)
        return 0;
    const int down = add_corner(b, foot[0]);
    return add_edge(b, down, add_corner(b, foot[1]), left, right);
}

/* The corners and edges of a solid whose planes were added from `plane` on. */
struct solid {
    const double (*corner)[3];
    const struct body_edge *edge;
    int corners, edges, plane, planes;
};

/* Where the plane runs through a solid, the feet of its sides. */
static int add_feet(struct sight_bodies *b, const struct solid *s, int first)
{
    static const double DOWN[4] = {0, 0, 0, 1};
    const int down = add_plane(b, DOWN);
    for (int i = 0; i < s->planes; i++) {
        int corner[4], n = 0;
        for (int k = 0; k < s->edges; k++) { /* two of a side's cross the plane, or none does */
            const struct body_edge *e = &s->edge[k];
            const int from = first + (e->left == i ? e->from : e->to),
                      to = first + (e->left == i ? e->to : e->from);
            if ((e->left != i && e->right != i)
                || (b->corner[2][from] > 0) == (b->corner[2][to] > 0) || n == 4)
                continue;
            corner[n++] = from;
            corner[n++] = to;
        }
        if (n == 4 && add_foot(b, corner, n, s->plane + i, down) < 0)
            return -1;
    }
    return 0;
}

static int add_solid(struct sight_bodies *b, const struct solid *s, const struct outline_frame *f)
{
    const int first = b->corners;
    double p[3], low = INFINITY;
    for (int i = 0; i < s->corners; i++) {
        sight_in_plane(f, s->corner[i], p);
        low = p[2] < low ? p[2] : low;
        if (add_corner(b, p) < 0)
            return -1;
    }
    for (int i = 0; i < s->edges; i++) {
        const struct body_edge *e = &s->edge[i];
        if (add_upper(b, first + e->from, first + e->to, s->plane + e->left, s->plane + e->right)
            < 0)
            return -1;
    }
    b->body[b->count].foot = !(low > 0);
    return low > 0 ? 0 : add_feet(b, s, first);
}

static int add_body_of(struct sight_bodies *b, const struct exchange_tree *t,
                       const struct body *body, const struct outline_frame *f)
{
    const struct bodies *all = &t->bodies;
    const struct solid s = {(const double(*)[3])(all->corners + body->corner),
                            all->edges + body->edge,
                            body->corners,
                            body->edges,
                            b->planes,
                            body->faces + body->lids};
    for (int i = 0; i < body->faces; i++) {
        const struct element *e = &t->h.elements[all->faces[body->face + (uint32_t)i]];
        if (add_plane_of(b, e->vertex[0], e->normal, f) < 0)
            return -1;
    }
    for (int i = 0; i < body->lids; i++) {
        const struct body_lid *lid = &all->lids[body->lid + (uint32_t)i];
        if (add_plane_of(b, lid->at, lid->n, f) < 0)
            return -1;
    }
    return add_solid(b, &s, f);
}

/* A face of no body is a plate: a front, a back, and nothing in it. */
static int add_plate(struct sight_bodies *b, const struct element *e, const struct outline_frame *f)
{
    const double back[3] = {-e->normal[0], -e->normal[1], -e->normal[2]};
    struct body_edge edge[4];
    const struct solid s = {
        (const double(*)[3])e->vertex, edge, e->vertices, e->vertices, b->planes, 2};
    for (int i = 0; i < e->vertices; i++)
        edge[i] = (struct body_edge){(uint8_t)i, (uint8_t)(i + 1 < e->vertices ? i + 1 : 0), 0, 1};
    return add_plane_of(b, e->vertex[0], e->normal, f) < 0
                   || add_plane_of(b, e->vertex[0], back, f) < 0
               ? -1
               : add_solid(b, &s, f);
}

/* The next body is made: where the one after it begins. */
static void add_body(struct sight_bodies *b)
{
    struct sight_body *body = &b->body[b->count];
    if (b->edges > body->edge) {
        body = &b->body[++b->count];
    } else { /* all of it is under the plane */
        b->corners = body->corner;
        b->planes = body->plane;
    }
    *body = (struct sight_body){b->corners, b->planes, b->edges, 0};
}

/* It takes so many faces for each shadow to be faster than without, unless they are few, and bodies
 * all. By the time of points in rooms of boxes and in a maze. */
enum { WORTH = 2, FEW = 2 };

/* What the faces of a list are of, each body and each plate once, by one of its faces. Returns how
 * many; -1: too many, or not worth it. */
static int find_solids(const struct bodies *all, const uint32_t *list, int count,
                       uint32_t face[SIGHT_BODIES])
{
    int found = 0, plates = 0;
    for (int i = 0; i < count; i++) {
        const uint32_t of = all->of[list[i]];
        int k = 0;
        while (k < found && !(of && all->of[face[k]] == of))
            k++;
        if (k == SIGHT_BODIES)
            return -1;
        if (k < found)
            continue;
        face[found++] = list[i];
        plates += !of;
    }
    return (plates > 0 || found > FEW) && WORTH * found > count ? -1 : found;
}

int sight_bodies_place(struct sight_bodies *b, const struct exchange_tree *t, const uint32_t *list,
                       int count, const struct outline_frame *f)
{
    uint32_t face[SIGHT_BODIES];
    const int solids = find_solids(&t->bodies, list, count, face);
    b->count = b->corners = b->planes = b->edges = 0;
    b->body[0] = (struct sight_body){0};
    if (solids < 0)
        return 0;
    for (int i = 0; i < solids; i++) {
        const uint32_t of = t->bodies.of[face[i]];
        if ((of ? add_body_of(b, t, &t->bodies.body[of - 1], f)
                : add_plate(b, &t->h.elements[face[i]], f))
            < 0)
            return 0;
        add_body(b);
    }
    for (int i = b->corners; i % LANES_MOST; i++) /* computed, not read */
        b->corner[0][i] = b->corner[1][i] = b->corner[2][i] = 0;
    for (int i = b->planes; i % LANES_MOST; i++)
        b->plane[0][i] = b->plane[1][i] = b->plane[2][i] = b->plane[3][i] = 0;
    for (int i = b->edges; i < b->edges + LANES_MOST; i++)
        for (int k = 0; k < 3; k++)
            b->end[0][k][i] = b->end[1][k][i] = 0;
    return 1;
}
