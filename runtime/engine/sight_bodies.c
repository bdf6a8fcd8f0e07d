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

/* The plane of a face. */
static int add_plane_of(struct sight_bodies *b, const struct element *e,
                        const struct outline_frame *f)
{
    double p[3],
        plane[4] = {dot3(e->normal, f->u), dot3(e->normal, f->v), dot3(e->normal, f->n), 0};
    sight_in_plane(f, e->vertex[0], p);
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
    b->edge[b->edges++] =
        (struct sight_body_edge){(int16_t)from, (int16_t)to, (int16_t)left, (int16_t)right};
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

static int add_solid(struct sight_bodies *b, const struct exchange_tree *t, const struct body *body,
                     const struct outline_frame *f)
{
    static const double DOWN[4] = {0, 0, 0, 1};
    const struct bodies *all = &t->bodies;
    const int corners = b->corners, planes = b->planes;
    double p[3], low = INFINITY;
    for (int i = 0; i < body->corners; i++) {
        sight_in_plane(f, all->corners[body->corner + (uint32_t)i], p);
        low = p[2] < low ? p[2] : low;
        if (add_corner(b, p) < 0)
            return -1;
    }
    for (int i = 0; i < body->faces; i++)
        if (add_plane_of(b, &t->h.elements[all->faces[body->face + (uint32_t)i]], f) < 0)
            return -1;
    for (int i = 0; i < body->edges; i++) {
        const struct body_edge *e = &all->edges[body->edge + (uint32_t)i];
        if (add_upper(b, corners + e->from, corners + e->to, planes + e->left, planes + e->right)
            < 0)
            return -1;
    }
    b->body[b->count].foot = !(low > 0);
    const int down = low > 0 ? 0 : add_plane(b, DOWN);
    for (int i = 0; i < body->faces && !(low > 0); i++) {
        int corner[4], n = 0;
        for (int k = 0; k < body->edges;
             k++) { /* two of the face's cross the plane, or none does */
            const struct body_edge *e = &all->edges[body->edge + (uint32_t)k];
            const int from = corners + (e->left == i ? e->from : e->to),
                      to = corners + (e->left == i ? e->to : e->from);
            if ((e->left != i && e->right != i)
                || (b->corner[2][from] > 0) == (b->corner[2][to] > 0) || n == 4)
                continue;
            corner[n++] = from;
            corner[n++] = to;
        }
        if (n == 4 && add_foot(b, corner, n, planes + i, down) < 0)
            return -1;
    }
    return 0;
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

int sight_bodies_place(struct sight_bodies *b, const struct exchange_tree *t, const uint32_t *list,
                       int count, const struct outline_frame *f)
{
    uint32_t met[SIGHT_BODIES];
    int bodies = 0;
    b->count = b->corners = b->planes = b->edges = 0;
    b->body[0] = (struct sight_body){0};
    for (int i = 0; i < count; i++) {
        const uint32_t of = t->bodies.of[list[i]];
        int k = 0;
        while (k < bodies && met[k] != of)
            k++;
        if (of && k < bodies)
            continue;
        if (!of || bodies == SIGHT_BODIES || add_solid(b, t, &t->bodies.body[of - 1], f) < 0)
            return 0;
        add_body(b);
        met[bodies++] = of;
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
