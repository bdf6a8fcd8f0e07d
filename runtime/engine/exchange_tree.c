/* exchange_tree.c - the tree of elements that `viewfactors` refines.
 *
 * A matrix needs every pair of faces, so what a hierarchy can save is not links but questions: whether anything stands
 * between, how near, who turns to whom. These have one answer for all pairs of two walls' patches. Clusters by the surface-area
 * heuristic (runtime/hierarchy.c) mix a wall with the strip of floor beside it, and nothing is true of such a group. So here
 * faces are first gathered by plane; each plane's faces make a tree of rectangles, each of which is a surface that shafts,
 * distances and planes can be asked about; above the planes stand clusters.
 *
 * What blocks light is as few as possible: the largest groups whose faces tile their rectangle stand in shafts as one
 * face each. They do when every edge that no neighbour cancels lies on the rectangle's sides, so that all of it is covered
 * equally often, and the areas say once.
 *
 * Invariant: a group's faces lie in its plane, to host.flat, and within its rectangle, to rounding; the tree depends on the faces alone.
 * [derived here; the cancelling of edges is that of winding numbers]
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "engine/exchange_tree.h"
#include "kernel/hash.h"
#include "kernel/shaft.h"
#include "tools/group_level.h"

/* Faces of a lowest group, and children of the others. Shadows are looked for group by group: 16 faces are as good as 8 or 32. */
enum { LEAF = 16, FANOUT = 4 };

struct item { /* a face while planes are gathered; later a plane's faces, order[from .. to - 1] */
    double key[4]; /* normal, height of the plane */
    uint32_t face, from, to;
};

struct directed { /* an edge, for cancelling */
    double a[2], b[2];
};

struct builder {
    struct exchange_tree *t;
    struct hierarchy *h;
    const struct hierarchy *plain; /* measured face elements, and the scene's box */
    double flat, size;             /* m */
    struct item *items;            /* [face_count]: the faces, by planes; then [planes] */
    uint32_t planes;
    double (*at)[2];               /* [face_count]: by face, the middle of its rectangle in its plane's frame */
    double (*centre)[3];           /* [planes]: the middle of the plane's box */
    struct directed *edges;        /* [8 * face_count] */
};

/* The frame of a plane. */
struct frame {
    double origin[3], u[3], v[3], n[3];
};

static const struct element *face_of(const struct builder *b, uint32_t face)
{
    return &b->plain->elements[b->plain->face_element[face]];
}

/* ---- faces gathered by plane */

static int compare_key(const struct item *a, const struct item *b, int k)
{
    return a->key[k] < b->key[k] ? -1 : a->key[k] > b->key[k] ? 1 : a->face < b->face ? -1 : a->face > b->face;
}

static int by_x(const void *a, const void *b) { return compare_key(a, b, 0); }
static int by_y(const void *a, const void *b) { return compare_key(a, b, 1); }
static int by_z(const void *a, const void *b) { return compare_key(a, b, 2); }
static int by_height(const void *a, const void *b) { return compare_key(a, b, 3); }

static int by_face(const void *a, const void *b)
{
    const struct item *x = a, *y = b;
    return x->face < y->face ? -1 : x->face > y->face;
}

/* Do the faces lie in the plane of the largest of them? */
static int one_plane(const struct builder *b, const struct item *items, uint32_t count)
{
    const struct element *plane = face_of(b, items[0].face);
    uint32_t i;
    int k;
    for (i = 1; i < count; i++)
        if (face_of(b, items[i].face)->area > plane->area)
            plane = face_of(b, items[i].face);
    for (i = 0; i < count; i++) {
        const struct element *e = face_of(b, items[i].face);
        if (!(dot3(e->normal, plane->normal) > 0.99999) || b->h->faces[e->face].back != b->h->faces[plane->face].back)
            return 0;
        for (k = 0; k < e->vertices; k++)
            if (!(fabs(height3(e->vertex[k], plane->centre, plane->normal)) <= b->flat))
                return 0;
    }
    return 1;
}

/* Part a run of items where key k leaves a gap, each part by the next key, until they are planes; a run that is none is left as
 * single faces. Writes where each plane begins. */
static void gather(struct builder *b, uint32_t from, uint32_t to, int k, unsigned char *begins)
{
    static int (*const order[4])(const void *, const void *) = { by_x, by_y, by_z, by_height };
    double gap = k < 3 ? 1e-5 : 0.5 * b->flat;
    uint32_t i, start;
    if (k == 4) {
        int flat = one_plane(b, b->items + from, to - from);
        qsort(b->items + from, to - from, sizeof *b->items, by_face);
        begins[from] = 1;
        for (i = from + 1; i < to; i++)
            begins[i] = !flat;
        return;
    }
    qsort(b->items + from, to - from, sizeof *b->items, order[k]);
    for (start = from, i = from + 1; i <= to; i++)
        if (i == to || b->items[i].key[k] - b->items[i - 1].key[k] > gap) {
            gather(b, start, i, k + 1, begins);
            start = i;
        }
}

static int gather_planes(struct builder *b)
{
    uint32_t n = b->h->face_count, i;
    unsigned char *begins = calloc(n, 1);
    int k;
    if (!begins)
        return -1;
    for (i = 0; i < n; i++) {
        const struct element *e = face_of(b, i);
        struct item *x = &b->items[i];
        x->face = i;
        for (k = 0; k < 3; k++)
            x->key[k] = e->normal[k];
        x->key[3] = 0;
        for (k = 0; k < 3; k++) /* about the scene's middle, where rounding is least; far sides apart from fronts */
            x->key[3] += e->normal[k] * (e->centre[k] - 0.5 * (b->plain->low[k] + b->plain->high[k]));
        x->key[3] += b->h->faces[i].back * 4 * b->size;
    }
    gather(b, 0, n, 0, begins);
    for (i = 0; i < n; i++)
        b->h->order[i] = b->items[i].face;
    for (b->planes = 0, i = 0; i < n; i++) {
        if (begins[i])
            b->items[b->planes++].from = i;
        b->items[b->planes - 1].to = i + 1;
    }
    free(begins);
    for (i = 0; i < b->planes; i++) {
        struct item *x = &b->items[i];
        double low[3] = { INFINITY, INFINITY, INFINITY }, high[3] = { -INFINITY, -INFINITY, -INFINITY };
        uint32_t j;
        for (j = x->from; j < x->to; j++) {
            const struct element *e = face_of(b, b->h->order[j]);
            int c;
            for (c = 0; c < e->vertices; c++)
                for (k = 0; k < 3; k++) {
                    low[k] = e->vertex[c][k] < low[k] ? e->vertex[c][k] : low[k];
                    high[k] = e->vertex[c][k] > high[k] ? e->vertex[c][k] : high[k];
                }
        }
        for (k = 0; k < 3; k++)
            b->centre[i][k] = 0.5 * (low[k] + high[k]);
    }
    return 0;
}

/* ---- elements */

static uint32_t add_children(struct builder *b, uint32_t parent, int count)
{
    struct hierarchy *h = b->h;
    uint32_t first = h->count, i;
    h->elements[parent].child = first;
    h->elements[parent].children = (uint8_t)count;
    h->count += (uint32_t)count;
    for (i = first; i < h->count; i++) {
        memset(&h->elements[i], 0, sizeof *h->elements);
        h->elements[i].parent = parent;
        h->elements[i].id = hash64(i + HASH_STEP);
        h->elements[i].importance = 1;
        h->elements[i].tolerance = INFINITY;
        h->elements[i].radiosity = 1;
    }
    return first;
}

static void make_face(struct builder *b, uint32_t index, uint32_t at)
{
    struct hierarchy *h = b->h;
    struct element *e = &h->elements[index];
    uint32_t parent = e->parent, face = h->order[at];
    *e = *face_of(b, face);
    e->parent = parent;
    e->radiosity = 1;
    e->reflectance = 0;
    e->black = 0;
    h->face_element[face] = index;
    h->range[index] = (struct face_range){ at, at + 1 };
    b->t->solid[index] = 1;
}

/* The frame of a plane's faces: the first axis along the longest edge of the largest face. */
static void make_frame(const struct builder *b, struct face_range range, struct frame *f)
{
    const struct element *e = face_of(b, b->h->order[range.from]);
    double best = 0;
    uint32_t i;
    int c, k;
    for (i = range.from; i < range.to; i++)
        if (face_of(b, b->h->order[i])->area > e->area * (1 + 1e-9))
            e = face_of(b, b->h->order[i]);
    memcpy(f->n, e->normal, sizeof f->n);
    memcpy(f->origin, e->centre, sizeof f->origin);
    for (c = 0; c < e->vertices; c++) {
        double edge[3], size;
        sub3(edge, e->vertex[c + 1 < e->vertices ? c + 1 : 0], e->vertex[c]);
        size = length3(edge);
        if (size <= best * (1 + 1e-9))
            continue;
        best = size;
        for (k = 0; k < 3; k++)
            f->u[k] = edge[k] / size;
    }
    cross3(f->v, f->n, f->u);
    best = length3(f->v);
    for (k = 0; k < 3; k++)
        f->v[k] /= best;
    cross3(f->u, f->v, f->n);
}

static void in_frame(const struct frame *f, const double p[3], double uv[2])
{
    double w[3];
    sub3(w, p, f->origin);
    uv[0] = dot3(w, f->u);
    uv[1] = dot3(w, f->v);
}

static void bounds(const struct builder *b, const struct frame *f, struct face_range range, double low[2], double high[2])
{
    uint32_t i;
    int c, k;
    low[0] = low[1] = INFINITY;
    high[0] = high[1] = -INFINITY;
    for (i = range.from; i < range.to; i++) {
        const struct element *e = face_of(b, b->h->order[i]);
        for (c = 0; c < e->vertices; c++) {
            double uv[2];
            in_frame(f, e->vertex[c], uv);
            for (k = 0; k < 2; k++) {
                low[k] = uv[k] < low[k] ? uv[k] : low[k];
                high[k] = uv[k] > high[k] ? uv[k] : high[k];
            }
        }
    }
}

static int compare_edges(const void *a, const void *b)
{
    return memcmp(a, b, sizeof(struct directed));
}

/* Do the faces tile the rectangle? Edges run both ways between neighbours: written from the smaller end, with which way in the
 * list's half. */
static int tiles(const struct builder *b, const struct frame *f, struct face_range range, const double low[2], const double high[2])
{
    double area = 0, whole = (high[0] - low[0]) * (high[1] - low[1]), near = b->flat;
    size_t count[2] = { 0, 0 }, i, j;
    struct directed *half[2];
    uint32_t r;
    half[0] = b->edges;
    half[1] = b->edges + 4 * (size_t)b->h->face_count;
    for (r = range.from; r < range.to; r++) {
        const struct element *e = face_of(b, b->h->order[r]);
        int c, k;
        area += e->area;
        for (c = 0; c < e->vertices; c++) {
            double end[2][2];
            int side = 0, turned;
            struct directed *g;
            in_frame(f, e->vertex[c], end[0]);
            in_frame(f, e->vertex[c + 1 < e->vertices ? c + 1 : 0], end[1]);
            for (k = 0; k < 2; k++)
                side |= (end[0][k] < low[k] + near && end[1][k] < low[k] + near)
                     || (end[0][k] > high[k] - near && end[1][k] > high[k] - near);
            if (side)
                continue;
            for (k = 0; k < 4; k++) { /* corners that are one in the file are one here */
                end[k / 2][k % 2] = floor(end[k / 2][k % 2] / near * 0.125 + 0.5);
                end[k / 2][k % 2] += 0.0; /* no negative zero */
            }
            turned = end[0][0] > end[1][0] || (end[0][0] >= end[1][0] && end[0][1] > end[1][1]);
            g = &half[turned][count[turned]++];
            memcpy(g->a, end[turned], sizeof g->a);
            memcpy(g->b, end[!turned], sizeof g->b);
        }
    }
    if (count[0] != count[1] || fabs(area - whole) > 1e-5 * whole)
        return 0;
    for (i = 0; i < 2; i++)
        qsort(half[i], count[i], sizeof **half, compare_edges);
    for (j = 0; j < count[0]; j++)
        if (compare_edges(&half[0][j], &half[1][j]) != 0)
            return 0;
    return 1;
}

static void make_rectangle(struct builder *b, uint32_t index, const struct frame *f, struct face_range range, int within_solid)
{
    struct element *e = &b->h->elements[index];
    double low[2], high[2];
    uint32_t i;
    int c, k;
    bounds(b, f, range, low, high);
    for (c = 0; c < 4; c++)
        for (k = 0; k < 3; k++)
            e->vertex[c][k] = f->origin[k] + (c == 1 || c == 2 ? high[0] : low[0]) * f->u[k] + (c >= 2 ? high[1] : low[1]) * f->v[k];
    for (k = 0; k < 3; k++) {
        e->centre[k] = 0.5 * (e->vertex[0][k] + e->vertex[2][k]);
        e->normal[k] = f->n[k];
    }
    e->radius = 0.5 * sqrt((high[0] - low[0]) * (high[0] - low[0]) + (high[1] - low[1]) * (high[1] - low[1]));
    for (i = range.from; i < range.to; i++)
        e->area += face_of(b, b->h->order[i])->area;
    e->cone = 1;
    e->vertices = 4;
    e->face = GROUP_FACE;
    b->h->range[index] = range;
    b->t->solid[index] = (unsigned char)(!within_solid && tiles(b, f, range, low, high));
}

/* ---- splitting */

struct along {
    double at;
    uint32_t what;
};

static int compare_along(const void *a, const void *b)
{
    const struct along *x = a, *y = b;
    return x->at < y->at ? -1 : x->at > y->at ? 1 : x->what < y->what ? -1 : x->what > y->what;
}

/* The place nearest to the middle of a sorted list where neighbours differ; the middle when none do. */
static uint32_t middle(const struct along *list, uint32_t count, double near)
{
    uint32_t step, half = count / 2;
    for (step = 0; step < half; step++) {
        if (list[half + step < count ? half + step : count - 1].at - list[half + step - 1].at > near)
            return half + step;
        if (half > step + 1 && list[half - step].at - list[half - step - 1].at > near)
            return half - step;
    }
    return half;
}

/* Parts of a range, each halved across its longer side. `centre`: by what order or items hold. Returns how many, up to FANOUT. */
static int halve(const struct builder *b, uint32_t *list, struct face_range range, const double *centre, size_t stride, int axes,
                 struct along *scratch, struct face_range part[FANOUT], uint32_t least)
{
    int parts = 1, k;
    uint32_t i;
    part[0] = range;
    while (parts < FANOUT) {
        double low[3] = { INFINITY, INFINITY, INFINITY }, high[3] = { -INFINITY, -INFINITY, -INFINITY };
        int widest = 0, axis = 0;
        uint32_t n, cut, *own;
        for (k = 1; k < parts; k++)
            if (part[k].to - part[k].from > part[widest].to - part[widest].from)
                widest = k;
        n = part[widest].to - part[widest].from;
        if (n < 2 || (n <= least && parts > 1))
            break;
        own = list + part[widest].from;
        for (i = 0; i < n; i++)
            for (k = 0; k < axes; k++) {
                double x = centre[stride * own[i] + (size_t)k];
                low[k] = x < low[k] ? x : low[k];
                high[k] = x > high[k] ? x : high[k];
            }
        for (k = 1; k < axes; k++)
            if (high[k] - low[k] > (high[axis] - low[axis]) * (1 + 1e-6))
                axis = k;
        for (i = 0; i < n; i++)
            scratch[i] = (struct along){ centre[stride * own[i] + (size_t)axis], own[i] };
        qsort(scratch, n, sizeof *scratch, compare_along);
        cut = middle(scratch, n, 1e-6 * b->size);
        for (i = 0; i < n; i++)
            own[i] = scratch[i].what;
        memmove(&part[widest + 1], &part[widest], (size_t)(parts - widest) * sizeof *part);
        part[widest].to = part[widest + 1].from = part[widest].from + cut;
        parts++;
    }
    return parts;
}

/* Element `index` becomes the group of the faces in the range, or the one face. */
static void make_group(struct builder *b, struct along *scratch, uint32_t index, const struct frame *f, struct face_range range, int within_solid)
{
    struct face_range part[FANOUT];
    uint32_t n = range.to - range.from, first, i;
    int parts, k;
    if (n == 1) {
        make_face(b, index, range.from);
        return;
    }
    make_rectangle(b, index, f, range, within_solid);
    within_solid |= b->t->solid[index];
    if (n <= LEAF) {
        first = add_children(b, index, (int)n);
        for (i = 0; i < n; i++)
            make_face(b, first + i, range.from + i);
        return;
    }
    parts = halve(b, b->h->order, range, b->at[0], 2, 2, scratch, part, LEAF);
    first = add_children(b, index, parts);
    for (k = 0; k < parts; k++)
        make_group(b, scratch, first + (uint32_t)k, f, part[k], within_solid);
}

static void measure_cluster(struct builder *b, uint32_t index)
{
    struct element *e = &b->h->elements[index];
    struct face_range range = b->h->range[index];
    double axis[3] = { 0, 0, 0 }, size;
    uint32_t i;
    int c, k;
    for (k = 0; k < 3; k++) {
        e->vertex[0][k] = INFINITY;
        e->vertex[1][k] = -INFINITY;
    }
    for (i = range.from; i < range.to; i++) {
        const struct element *s = face_of(b, b->h->order[i]);
        e->area += s->area;
        for (k = 0; k < 3; k++) {
            axis[k] += s->area * s->normal[k];
            for (c = 0; c < s->vertices; c++) {
                e->vertex[0][k] = s->vertex[c][k] < e->vertex[0][k] ? s->vertex[c][k] : e->vertex[0][k];
                e->vertex[1][k] = s->vertex[c][k] > e->vertex[1][k] ? s->vertex[c][k] : e->vertex[1][k];
            }
        }
    }
    size = length3(axis);
    e->cone = size > 1e-9 * e->area ? 1 : -1;
    for (k = 0; k < 3; k++) {
        e->normal[k] = size > 0 ? axis[k] / size : 0;
        e->centre[k] = 0.5 * (e->vertex[0][k] + e->vertex[1][k]);
        axis[k] = e->vertex[1][k] - e->vertex[0][k];
    }
    for (i = range.from; i < range.to && e->cone > 0; i++) {
        double turn = dot3(face_of(b, b->h->order[i])->normal, e->normal);
        if (turn < 1 - 1e-14 && turn < e->cone)
            e->cone = turn;
    }
    e->radius = 0.5 * length3(axis);
}

/* Element `index` becomes the cluster of the planes list[range], or the one plane's group. Orders the faces as it goes:
 * `at` is where the first one's stand. */
static void make_cluster(struct builder *b, struct along *scratch, uint32_t *list, uint32_t *order, uint32_t index, struct face_range range, uint32_t at)
{
    struct face_range part[FANOUT];
    uint32_t first, i;
    int parts, k;
    if (range.to - range.from == 1 && index != 0) {
        const struct item *plane = &b->items[list[range.from]];
        struct face_range faces = { at, at + plane->to - plane->from };
        struct frame f;
        memcpy(b->h->order + at, order + plane->from, (plane->to - plane->from) * sizeof *order);
        if (faces.to - faces.from > 1) {
            make_frame(b, faces, &f);
            for (i = faces.from; i < faces.to; i++) {
                double low[2], high[2];
                struct face_range one = { i, i + 1 };
                bounds(b, &f, one, low, high);
                for (k = 0; k < 2; k++)
                    b->at[b->h->order[i]][k] = 0.5 * (low[k] + high[k]);
            }
        }
        make_group(b, scratch, index, &f, faces, 0);
        return;
    }
    parts = range.to - range.from > 1 ? halve(b, list, range, b->centre[0], 3, 3, scratch, part, 1) : 1;
    if (parts == 1)
        part[0] = range;
    first = add_children(b, index, parts);
    b->h->range[index].from = at;
    for (k = 0; k < parts; k++) {
        make_cluster(b, scratch, list, order, first + (uint32_t)k, part[k], at);
        at = b->h->range[first + (uint32_t)k].to;
    }
    b->h->range[index].to = at;
    measure_cluster(b, index);
}

/* ---- the host */

static const struct exchange_tree *tree_of(const struct host *host)
{
    return (const struct exchange_tree *)(const void *)host;
}

static uint64_t occluded(const struct host *host, int count, const struct segment *segments)
{
    const struct host *rays = rays_host(tree_of(host)->rays);
    return rays->occluded(rays, count, segments);
}

struct walk {
    const struct exchange_tree *t;
    const struct shaft *shaft;
    int most, found;
    uint32_t *elements;
};

static int visit(struct walk *w, uint32_t index)
{
    const struct hierarchy *h = &w->t->h;
    const struct element *e = &h->elements[index];
    int c, k, i;
    if (w->t->solid[index]) {
        if (h->faces[h->order[h->range[index].from]].back || !shaft_meets(w->shaft, (const double (*)[3])e->vertex, e->vertices, NULL))
            return 0;
        if (w->found == w->most)
            return -1;
        w->elements[w->found++] = index;
        return 0;
    }
    if (e->vertices) { /* a rectangle, not tiled */
        double low[3], high[3];
        for (k = 0; k < 3; k++) {
            low[k] = high[k] = e->vertex[0][k];
            for (i = 1; i < 4; i++) {
                low[k] = e->vertex[i][k] < low[k] ? e->vertex[i][k] : low[k];
                high[k] = e->vertex[i][k] > high[k] ? e->vertex[i][k] : high[k];
            }
            low[k] -= w->t->host.flat;
            high[k] += w->t->host.flat;
        }
        if (shaft_misses_box(w->shaft, low, high))
            return 0;
    } else if (shaft_misses_box(w->shaft, e->vertex[0], e->vertex[1])) {
        return 0;
    }
    for (c = 0; c < e->children; c++)
        if (visit(w, e->child + (uint32_t)c) < 0)
            return -1;
    return 0;
}

/* "Faces" are elements here: faces, and groups that are as good as one. */
static int candidates(const struct host *host, const struct shaft *shaft, int most, uint32_t *elements)
{
    struct walk w = { tree_of(host), shaft, most, 0, elements };
    return visit(&w, 0) < 0 ? most + 1 : w.found;
}

static void corners(const struct host *host, uint32_t index, struct polygon *polygon)
{
    const struct element *e = &tree_of(host)->h.elements[index];
    polygon->n = e->vertices;
    memcpy(polygon->v, e->vertex, e->vertices * sizeof *e->vertex);
}

/* ---- */

static int build(struct exchange_tree *t, const struct hierarchy *plain, double flat)
{
    struct hierarchy *h = &t->h;
    uint32_t n = h->face_count, most = 2 * n + 2, i, *list = malloc(n * sizeof *list), *order = malloc(n * sizeof *order);
    struct along *scratch = malloc(n * sizeof *scratch);
    struct builder b = { .t = t, .h = h, .plain = plain, .flat = flat };
    int result = -1, k;
    b.items = malloc(n * sizeof *b.items);
    b.at = calloc(n, sizeof *b.at);
    b.centre = malloc(n * sizeof *b.centre);
    b.edges = malloc(8 * (size_t)n * sizeof *b.edges);
    h->elements = malloc(most * sizeof *h->elements);
    h->capacity = most;
    h->face_element = malloc(n * sizeof *h->face_element);
    h->order = malloc(n * sizeof *h->order);
    h->range = malloc(most * sizeof *h->range);
    t->solid = calloc(most, 1);
    if (!list || !order || !scratch || !b.items || !b.at || !b.centre || !b.edges || !h->elements || !h->face_element || !h->order || !h->range || !t->solid)
        goto done;
    for (k = 0; k < 3; k++) {
        double side = plain->high[k] - plain->low[k];
        h->low[k] = plain->low[k];
        h->high[k] = plain->high[k];
        b.size = side > b.size ? side : b.size;
    }
    if (gather_planes(&b) < 0)
        goto done;
    memcpy(order, h->order, n * sizeof *order);
    for (i = 0; i < b.planes; i++)
        list[i] = i;
    h->count = 1;
    memset(h->elements, 0, sizeof *h->elements);
    h->elements[0].id = hash64(HASH_STEP);
    h->elements[0].importance = 1;
    h->elements[0].tolerance = INFINITY;
    h->elements[0].radiosity = 1;
    make_cluster(&b, scratch, list, order, 0, (struct face_range){ 0, b.planes }, 0);
    h->built = h->count;
    result = 0;
done:
    free(list);
    free(order);
    free(scratch);
    free(b.items);
    free(b.at);
    free(b.centre);
    free(b.edges);
    return result;
}

int exchange_tree_open(struct exchange_tree *t, const struct face *faces, uint32_t face_count, int threads, const char **cause)
{
    struct hierarchy plain = { 0 };
    double *unit = malloc(face_count * sizeof *unit), *black = calloc(face_count, sizeof *black);
    uint32_t i;
    memset(t, 0, sizeof *t);
    *cause = "out of memory";
    if (!unit || !black || face_count > UINT32_MAX / 16 || hierarchy_build(&plain, faces, face_count) < 0)
        goto fail;
    for (i = 0; i < face_count; i++)
        unit[i] = 1;
    t->rays = rays_open(&plain, unit, black, threads, cause);
    if (!t->rays)
        goto fail;
    t->h.faces = faces;
    t->h.face_count = face_count;
    if (build(t, &plain, rays_host(t->rays)->flat) < 0)
        goto fail;
    t->host = *rays_host(t->rays);
    t->host.occluded = occluded;
    t->host.candidates = candidates;
    t->host.corners = corners;
    t->host.optical_depth = NULL;
    t->host.elements = (const struct element *const *)&t->h.elements;
    hierarchy_free(&plain); /* of the rays' host, only rays are asked from here on */
    free(unit);
    free(black);
    return 0;
fail:
    exchange_tree_close(t);
    hierarchy_free(&plain);
    free(unit);
    free(black);
    return -1;
}

void exchange_tree_close(struct exchange_tree *t)
{
    rays_close(t->rays);
    hierarchy_free(&t->h);
    free(t->solid);
    memset(t, 0, sizeof *t);
}

struct face_range exchange_tree_range(const struct exchange_tree *t, uint32_t element)
{
    if (element >= t->h.built)
        element = t->h.face_element[t->h.elements[element].face];
    return t->h.range[element];
}
