/* point_view.c - what a point sees of each polygon, cut out exactly.
 *
 * The factor from a point to a polygon is a sum over its edges (kernel/lambert.h), so what is left
 * of a face past others need only be known as polygons. Seen from the point, a face is a cone, and
 * what lies between the point and another face's plane hides there what is in its cone: cells are
 * cut by the planes through the point and the edges. Where many faces overlap a cell, it is halved,
 * and each half asks those that overlap it alone, until so few are left that what lies beside one
 * after the other can be cut off; what is whole in one cone is gone.
 * Invariant: cells lie in the face's plane, above the point's horizon, and do not overlap; nothing
 * is sampled, so a closed room sums to 1 but for rounding.
 * Of faces in one plane, a front hides the backs. What the point itself lies in is seen edge on: it
 * is not seen and hides nothing, as the wall that a sensor is mounted on.
 * [point to polygon: Lambert 1760; the parts left by cutting: Weiler & Atherton 1977; halving:
 * Warnock 1969]
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "engine/point_view.h"
#include "hierarchy/polygon.h"
#include "kernel/lambert.h"
#include "util/array.h"

/* FEW: cones that are cut off one after the other; a cell gains at most six corners by each.
 * HALVINGS: a cell is then so small that what more than a few hide of it is nothing. STACK: of the
 * tree. */
enum { CORNERS = 64, FEW = 8, HALVINGS = 48, EDGES = 5, STACK = 2 * DEPTH_MAX * PARTS_MAX };

/* Of the scene's extent and of its coordinates: what is nearer to a plane lies in it. TOUCH: of the
 * distance: what is nearer to a cone's side touches it. */
static const double NEAR = 1e-9, ROUNDING = 4e-16, TOUCH = 1e-13;

/* A convex polygon; corners relative to the point. */
struct cell {
    int n;
    double p[CORNERS][3];
};

/* What a face hides: where all edges' planes have p.normal <= 0; normals have length 1. */
struct cone {
    int n;
    double normal[EDGES][3];
};

struct cones {
    struct cone *all; /* [count] */
    size_t count, capacity;
};

/* A face as the point sees it: corners relative to the point, the plane's height over it. */
struct seen_face {
    int n;
    double p[4][3], normal[3], height; /* height > 0: its front */
};

struct watcher {
    const struct point_view *view;
    double x[3], n[3];
    struct cones cones;
    int failed;
};

int point_view_open(struct point_view *v, const struct scene *scene, int threads)
{
    double size = 0, far = 0;
    *v = (struct point_view){.scene = scene};
    if (bvh_build(&v->tree, scene->faces, scene->face_count, CLUSTERING_SAH, threads) < 0)
        return -1;
    for (int k = 0; k < 3 && v->tree.count; k++) {
        const struct bounds *box = &v->tree.boxes[0];
        size = fmax(size, box->high[k] - box->low[k]);
        far = fmax(far, fmax(fabs(box->low[k]), fabs(box->high[k])));
    }
    v->blur = ROUNDING * far;
    v->near = NEAR * size + (4 * scene->precision + ROUNDING) * far;
    return 0;
}

void point_view_close(struct point_view *v)
{
    bvh_free(&v->tree);
    *v = (struct point_view){0};
}

static void see_face(const struct watcher *w, uint32_t face, struct seen_face *s)
{
    const struct face *f = &w->view->scene->faces[face];
    s->n = (int)f->vertices;
    for (int i = 0; i < s->n; i++)
        sub3(s->p[i], f->vertex[i], w->x);
    (void)polygon_normal(s->p, f->vertices, s->normal);
    s->height = 0;
    for (int i = 0; i < s->n; i++)
        s->height -= dot3(s->normal, s->p[i]) / s->n;
}

static double cell_factor(const struct watcher *w, const struct cell *c)
{
    static const double origin[3] = {0};
    return fabs(lambert_sum(origin, w->n, (const double(*)[3])c->p, c->n));
}

/* The heights of a cell's corners over a plane through the point. Returns 1: all at or above it,
 * -1: at or below it, 0: neither. */
static int cell_side(const struct cell *c, const double normal[3], double blur, double h[CORNERS])
{
    int above = 0, below = 0;
    for (int i = 0; i < c->n; i++) {
        h[i] = dot3(normal, c->p[i]);
        if (h[i] * h[i] <= TOUCH * TOUCH * dot3(c->p[i], c->p[i]) || fabs(h[i]) <= blur)
            h[i] = 0;
        above += h[i] > 0;
        below += h[i] < 0;
    }
    return !below ? 1 : !above ? -1 : 0;
}

/* A cell to a cone: 1 whole in it, -1 beside it, 0 neither for sure. */
static int cell_to_cone(const struct cell *c, const struct cone *cone, double blur)
{
    double h[CORNERS];
    int in = 1;
    for (int e = 0; e < cone->n; e++) {
        int side = cell_side(c, cone->normal[e], blur, h);
        if (side > 0)
            return -1;
        in &= side < 0;
    }
    return in;
}

static void cell_cut(const struct cell *c, const double h[CORNERS], struct cell *above,
                     struct cell *below)
{
    above->n = polygon_divide(&c->p[0][0], c->n, 3, h, CORNERS, &above->p[0][0], &below->p[0][0],
                              &below->n);
}

/* What is seen of a cell past the cones from .. to - 1, cut off one after the other. */
static double past_few(const struct watcher *w, const struct cell *c, size_t from, size_t to)
{
    struct cell in = *c, out, rest;
    double seen = 0, h[CORNERS];
    while (from < to && cell_to_cone(c, &w->cones.all[from], w->view->blur) < 0)
        from++;
    if (c->n < 3 || from == to)
        return c->n < 3 ? 0 : cell_factor(w, c);
    const struct cone *cone = &w->cones.all[from];
    for (int e = 0; e < cone->n && in.n >= 3; e++) {
        int side = cell_side(&in, cone->normal[e], w->view->blur, h);
        if (side > 0)
            return seen + past_few(w, &in, from + 1, to);
        if (side < 0)
            continue;
        cell_cut(&in, h, &out, &rest);
        seen += past_few(w, &out, from + 1, to);
        in = rest;
    }
    return seen;
}

/* The plane through the point that parts a cell's two directions farthest from each other. */
static void halving_plane(const struct cell *c, double normal[3])
{
    double most = 0, d[CORNERS][3], apart[3];
    for (int i = 0; i < c->n; i++) {
        double size = length3(c->p[i]);
        for (int k = 0; k < 3; k++)
            d[i][k] = size > 0 ? c->p[i][k] / size : 0;
    }
    for (int i = 1; i < c->n; i++)
        for (int j = 0; j < i; j++) {
            sub3(apart, d[i], d[j]);
            double size = length3(apart);
            for (int k = 0; k < 3 && size > most; k++)
                normal[k] = apart[k] / size;
            most = fmax(most, size);
        }
}

/* What is seen of a cell past the cones from .. to - 1. */
static double past_many(struct watcher *w, const struct cell *c, size_t from, size_t to, int depth)
{
    size_t first = w->cones.count;
    if (array_reserve(&w->cones.all, first + (to - from), &w->cones.capacity, sizeof *w->cones.all)
        < 0)
        w->failed = 1;
    for (size_t i = from; i < to && !w->failed; i++) {
        int side = cell_to_cone(c, &w->cones.all[i], w->view->blur);
        if (side > 0) {
            w->cones.count = first;
            return 0;
        }
        if (side == 0)
            w->cones.all[w->cones.count++] = w->cones.all[i];
    }
    double seen = 0, normal[3] = {0}, h[CORNERS];
    size_t last = w->cones.count, few = last - first < FEW ? last : first + FEW;
    halving_plane(c, normal);
    seen = past_few(w, c, first, few); /* the nearest, which as a rule hide most */
    if (few < last && depth < HALVINGS && seen > 0 && cell_side(c, normal, 0, h) == 0) {
        struct cell half[2];
        seen = 0;
        cell_cut(c, h, &half[0], &half[1]);
        for (int i = 0; i < 2; i++)
            seen += half[i].n < 3 ? 0 : past_many(w, &half[i], first, last, depth + 1);
    }
    w->cones.count = first;
    return seen;
}

/* The unit normal, outwards, of the cone's side through the edge from a to b. */
static void side_normal(const double a[3], const double b[3], int front, double normal[3])
{
    double e[3];
    sub3(e, b, a);
    cross3(normal, a, e);
    double size = (front ? 1 : -1) * length3(normal);
    for (int k = 0; k < 3; k++)
        normal[k] = fabs(size) > 0 ? normal[k] / size : 0;
}

/* The cone of what of a face lies between the point and the plane of `of`. Returns 0: nothing. */
static int make_cone(const struct watcher *w, const struct seen_face *of, const struct seen_face *s,
                     struct cone *cone)
{
    double h[4], over = of->height > 0 ? 1 : -1, low = INFINITY, high = -INFINITY, q[EDGES][3];
    int n = s->n;
    if (fabs(s->height) <= w->view->near)
        return 0;
    for (int i = 0; i < n; i++) {
        h[i] = over * (dot3(of->normal, s->p[i]) + of->height);
        low = h[i] < low ? h[i] : low;
        high = h[i] > high ? h[i] : high;
        if (fabs(h[i]) <= w->view->near) /* a sliver's side would have any direction */
            h[i] = 0;
    }
    int flat = high <= w->view->near;
    if (flat && (low < -w->view->near || of->height > 0 || s->height < 0))
        return 0; /* behind; or in the plane, and no front on a back */
    if (flat || low >= -w->view->near)
        memcpy(q, s->p, (size_t)n * sizeof *q);
    else
        n = polygon_divide(&s->p[0][0], n, 3, h, EDGES, &q[0][0], NULL, NULL);
    if (n < 3)
        return 0;
    cone->n = n;
    for (int i = 0, j = n - 1; i < n; j = i++)
        side_normal(q[j], q[i], s->height > 0, cone->normal[j]);
    return 1;
}

/* A box beside a plane through the point: no corner has p.normal < 0. */
static int box_beside(const double low[3], const double high[3], const double normal[3])
{
    double least = 0;
    for (int k = 0; k < 3; k++)
        least += normal[k] * (normal[k] > 0 ? low[k] : high[k]);
    return least >= 0;
}

/* Could what is in the box hide something of the cell? */
static int box_matters(const struct watcher *w, const struct bounds *box,
                       const struct seen_face *of, const struct cone *around)
{
    double low[3], high[3], over = of->height > 0 ? 1 : -1, most = over * of->height, up = 0;
    sub3(low, box->low, w->x);
    sub3(high, box->high, w->x);
    for (int k = 0; k < 3; k++) {
        double n = over * of->normal[k];
        most += n * (n > 0 ? high[k] : low[k]);
        up += w->n[k] * (w->n[k] > 0 ? high[k] : low[k]);
    }
    if (most < -w->view->near || !(up > 0))
        return 0;
    for (int e = 0; e < around->n; e++)
        if (box_beside(low, high, around->normal[e]))
            return 0;
    return 1;
}

/* How far the point is from a box, squared. */
static double box_distance(const struct watcher *w, const struct bounds *box)
{
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        double d = fmax(fmax(box->low[k] - w->x[k], w->x[k] - box->high[k]), 0);
        sum += d * d;
    }
    return sum;
}

/* A node's children go onto the stack, the nearest on top: it hides most. Returns the new depth. */
static int push_children(const struct watcher *w, const struct bvh_node *node, uint32_t *stack,
                         int depth)
{
    double far[PARTS_MAX];
    for (uint32_t k = 0; k < node->children; k++) {
        double d = box_distance(w, &w->view->tree.boxes[node->child + k]);
        uint32_t i = k;
        for (; i > 0 && far[i - 1] < d; i--) {
            far[i] = far[i - 1];
            stack[depth + (int)i] = stack[depth + (int)i - 1];
        }
        far[i] = d;
        stack[depth + (int)i] = node->child + k;
    }
    return depth + (int)node->children;
}

/* Add the cone of a face where it could hide something of the cell. Returns 1 when it hides all. */
static int add_cone(struct watcher *w, uint32_t face, const struct seen_face *of,
                    const struct cell *cell)
{
    struct seen_face s;
    if (array_reserve(&w->cones.all, w->cones.count + 1, &w->cones.capacity, sizeof *w->cones.all)
        < 0) {
        w->failed = 1;
        return 0;
    }
    see_face(w, face, &s);
    struct cone *cone = &w->cones.all[w->cones.count];
    int side = make_cone(w, of, &s, cone) ? cell_to_cone(cell, cone, w->view->blur) : -1;
    w->cones.count += side >= 0;
    return side > 0;
}

/* The cones of all faces that could hide something of the cell, which is of face `own`. Returns 1
 * when one hides all of it. */
static int find_cones(struct watcher *w, uint32_t own, const struct seen_face *of,
                      const struct cell *cell)
{
    const struct bvh *t = &w->view->tree;
    struct cone around = {.n = 0}; /* EDGES: a face of 4 corners above the horizon */
    uint32_t stack[STACK];
    int depth = 1;
    for (int i = 0, j = cell->n - 1; i < cell->n; j = i++, around.n++)
        side_normal(cell->p[j], cell->p[i], of->height > 0, around.normal[around.n]);
    w->cones.count = 0;
    stack[0] = 0;
    while (depth && !w->failed) {
        uint32_t at = stack[--depth];
        const struct bvh_node *node = &t->nodes[at];
        if (!box_matters(w, &t->boxes[at], of, &around))
            continue;
        depth = push_children(w, node, stack, depth);
        uint32_t face = t->order[node->from];
        if (!node->children && face != own && !w->view->scene->faces[face].back
            && add_cone(w, face, of, cell))
            return 1;
    }
    return 0;
}

/* How much is seen of a face, from whichever side. */
static double face_share(struct watcher *w, uint32_t face, const struct seen_face *s)
{
    struct cell cell;
    double h[4];
    int above = 0;
    for (int i = 0; i < s->n; i++) {
        h[i] = dot3(w->n, s->p[i]);
        above += h[i] > 0;
    }
    if (!above)
        return 0;
    cell.n = polygon_divide(&s->p[0][0], s->n, 3, h, EDGES, &cell.p[0][0], NULL, NULL);
    if (cell.n < 3)
        return 0;
    return find_cones(w, face, s, &cell) ? 0 : past_many(w, &cell, 0, w->cones.count, 0);
}

int point_view_row(const struct point_view *v, const double position[3], const double normal[3],
                   double *row)
{
    const struct scene *scene = v->scene;
    struct watcher w = {.view = v};
    uint32_t n = scene->input_count;
    double sum = 0;
    memset(row, 0, ((size_t)n + 2) * sizeof *row);
    memcpy(w.x, position, sizeof w.x);
    memcpy(w.n, normal, sizeof w.n);
    for (uint32_t i = 0; i < scene->face_count && !w.failed; i++) {
        const struct face *f = &scene->faces[i];
        struct seen_face s;
        if (f->back)
            continue;
        see_face(&w, i, &s);
        if (fabs(s.height) <= v->near)
            continue;
        double share = face_share(&w, i, &s);
        row[s.height > 0 || scene_is_pair(scene, i) ? f->input : n + 1] += share;
        sum += share;
    }
    row[n] = sum < 1 ? 1 - sum : 0;
    free(w.cones.all);
    return w.failed ? -1 : 0;
}
