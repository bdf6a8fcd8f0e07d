/* hierarchy.c - elements from the tree of clusters, and split surfaces below the faces.
 *
 * The tree is a strategy's (bvh.h); here its nodes become elements, in the same places, with boxes,
 * areas and cones of normals. Cones are as tight as the faces allow: each cluster looks at all its
 * faces, not at its children's cones. Invariant: indices depend on the order of splits, until
 * hierarchy_settle makes them depend on what is split alone; identities (`id`) only on the path
 * from the root, and those of faces and their parts on the face alone.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "hierarchy/hierarchy.h"
#include "hierarchy/flat_clusters.h"
#include "kernel/constants.h"
#include "kernel/hash.h"
#include "kernel/surface.h"
#include "util/array.h"
#include "util/thread_pool.h"

/* What stands for a parent in the identities of faces, wherever the clusters put them. */
#define FACES 0x2545f4914f6cdd1du

static uint64_t child_id(uint64_t parent, uint32_t k)
{
    return hash64(parent * 4 + k + HASH_STEP);
}

void element_reset(struct element *e)
{
    e->importance = 1;
    e->tolerance = INFINITY;
    e->bend = (float)INFINITY;
}

static void make_face(struct hierarchy *h, uint32_t index, uint32_t face)
{
    struct element *e = &h->elements[index];
    const struct face *f = &h->faces[face];
    memcpy(e->vertex, f->vertex, sizeof e->vertex);
    e->vertices = (uint8_t)f->vertices;
    e->face = face;
    e->black = f->black;
    e->id = child_id(FACES, face);
    h->face_element[face] = index;
    surface_measure(e);
    element_reset(e);
}

void element_measure_cluster(struct element *e, const struct face_share *share,
                             const struct bounds *box, struct face_range range)
{
    double axis[3] = {0, 0, 0};
    element_reset(e);
    e->black = 1;
    for (uint32_t i = range.from; i < range.to; i++) {
        const struct face_share *s = &share[i];
        e->area += s->area;
        e->black = e->black && s->black;
        for (int k = 0; k < 3; k++)
            axis[k] += s->area * s->normal[k];
    }
    double size = length3(axis);
    e->cone = size > CONE_LEAST * e->area ? 1 : -1;
    for (int k = 0; k < 3; k++)
        e->normal[k] = size > 0 ? axis[k] / size : 0;
    for (uint32_t i = range.from; i < range.to && e->cone > -1; i++) {
        double c = dot3(share[i].normal, e->normal);
        if (c < 1 - CONE_EQUAL && c < e->cone)
            e->cone = c;
    }
    for (int k = 0; k < 3; k++) {
        e->centre[k] = 0.5 * (box->low[k] + box->high[k]);
        e->vertex[0][k] = box->low[k];
        e->vertex[1][k] = box->high[k];
    }
    sub3(axis, box->high, box->low);
    e->radius = 0.5 * length3(axis);
}

int hierarchy_reserve(struct hierarchy *h, uint32_t more)
{
    if (more > UINT32_MAX - h->count)
        return -1;
    return array_reserve(&h->elements, (size_t)h->count + more, &h->capacity, sizeof *h->elements);
}

/* Parents, children, identities: from the root down. */
static void place_elements(struct hierarchy *h, const struct bvh *t)
{
    memset(h->elements, 0, t->count * sizeof *h->elements);
    h->elements[0].id = child_id(0, 0);
    for (uint32_t i = 0; i < t->count; i++) {
        const struct bvh_node *n = &t->nodes[i];
        struct element *e = &h->elements[i];
        h->range[i] = (struct face_range){n->from, n->to};
        e->child = n->child;
        e->children = (uint8_t)n->children;
        for (uint32_t k = 0; k < n->children; k++) {
            h->elements[n->child + k].parent = i;
            h->elements[n->child + k].id = child_id(e->id, k);
        }
    }
}

struct measuring {
    struct hierarchy *h;
    const struct bvh *t;
    struct face_share *share; /* [face in the tree's order] */
};

static void make_faces(const void *measuring, size_t from, size_t to)
{
    const struct measuring *m = measuring;
    for (uint32_t i = (uint32_t)from; i < to; i++) {
        const struct bvh_node *n = &m->t->nodes[i];
        if (n->children)
            continue;
        make_face(m->h, i, m->t->order[n->from]);
        const struct element *e = &m->h->elements[i];
        struct face_share *s = &m->share[n->from];
        memcpy(s->normal, e->normal, sizeof s->normal);
        s->area = e->area;
        s->black = e->black;
    }
}

static void measure_clusters(const void *measuring, size_t from, size_t to)
{
    const struct measuring *m = measuring;
    for (size_t i = from; i < to; i++)
        if (m->t->nodes[i].children)
            element_measure_cluster(&m->h->elements[i], m->share, &m->t->boxes[i], m->h->range[i]);
}

/* The tree over the faces that are not dark, and the dark ones after them in its order. Returns how
 * many are in it; 0 when out of memory. */
static uint32_t build_tree(struct bvh *t, const struct face *faces, uint32_t count,
                           enum clustering strategy, int threads)
{
    uint32_t held = 0, dark = 0;
    for (uint32_t i = 0; i < count; i++)
        dark += faces[i].light == FACE_DARK;
    if (dark == 0)
        return bvh_build(t, faces, count, strategy, threads) < 0 ? 0 : count;
    struct face *some = malloc(count * sizeof *some);
    uint32_t *order = malloc(count * sizeof *order), *of = malloc(count * sizeof *of);
    for (uint32_t i = 0; some && of && i < count; i++)
        if (faces[i].light != FACE_DARK) {
            some[held] = faces[i];
            of[held++] = i;
        }
    if (!order || held == 0 || bvh_build(t, some, held, strategy, threads) < 0) {
        free(some);
        free(order);
        free(of);
        return 0;
    }
    for (uint32_t i = 0; i < held; i++)
        order[i] = of[t->order[i]];
    for (uint32_t i = 0, n = held; i < count; i++)
        if (faces[i].light == FACE_DARK)
            order[n++] = i;
    free(t->order);
    t->order = order;
    free(some);
    free(of);
    return held;
}

/* Elements of the dark faces, behind those of the tree: of no cluster's. */
static void add_dark(struct hierarchy *h, uint32_t held)
{
    for (uint32_t i = held; i < h->face_count; i++) {
        const uint32_t index = h->count++;
        memset(&h->elements[index], 0, sizeof *h->elements);
        h->range[index] = (struct face_range){i, i + 1};
        make_face(h, index, h->order[i]);
    }
    h->built = h->count;
}

int hierarchy_build_by(struct hierarchy *h, const struct face *faces, uint32_t face_count,
                       enum clustering strategy, int threads)
{
    struct face_share *share = NULL;
    int result = -1;
    memset(h, 0, sizeof *h);
    struct bvh t;
    const uint32_t held = build_tree(&t, faces, face_count, strategy, threads);
    if (held == 0)
        return -1;
    const uint32_t dark = face_count - held;
    h->faces = faces;
    h->face_count = face_count;
    h->strategy = clustering_chosen(strategy, held);
    h->face_element = malloc(face_count * sizeof *h->face_element);
    h->range = malloc(((size_t)t.count + dark) * sizeof *h->range);
    share = malloc(face_count * sizeof *share);
    if (!h->face_element || !h->range || !share || hierarchy_reserve(h, t.count + dark) < 0)
        goto done;
    h->count = h->built = t.count;
    memcpy(h->low, t.boxes[0].low, sizeof h->low);
    memcpy(h->high, t.boxes[0].high, sizeof h->high);
    place_elements(h, &t);
    const struct measuring m = {h, &t, share};
    thread_pool_run(threads, t.count, 256, make_faces, &m);
    thread_pool_run(threads, t.count, 64, measure_clusters, &m);
    h->order = t.order;
    t.order = NULL;
    add_dark(h, held);
    result = flat_clusters_find(h);
done:
    free(share);
    bvh_free(&t);
    if (result < 0)
        hierarchy_free(h);
    return result;
}

int hierarchy_build(struct hierarchy *h, const struct face *faces, uint32_t face_count)
{
    return hierarchy_build_by(h, faces, face_count, CLUSTERING_DEFAULT, 1);
}

int hierarchy_split(struct hierarchy *h, uint32_t element)
{
    uint32_t first = h->count;
    if (h->elements[element].children)
        return 0;
    if (hierarchy_reserve(h, 4) < 0)
        return -1;
    struct element *e = &h->elements[element];
    for (uint32_t i = 0; i < 4; i++) {
        struct element *c = &h->elements[first + i];
        surface_quarter(e, (int)i, c);
        c->face = e->face;
        c->black = e->black;
        c->depth = (uint8_t)(e->depth + 1);
        c->parent = element;
        c->radiosity = e->radiosity;
        c->reflectance = e->reflectance;
        c->importance = e->importance;
        c->tolerance = e->tolerance;
        c->lower = e->lower;
        c->bend = e->bend;
        c->mark = e->mark;
        c->id = child_id(e->id, i);
    }
    e->child = first;
    e->children = 4;
    h->count += 4;
    return 0;
}

void hierarchy_drop(struct hierarchy *h, uint32_t count)
{
    for (uint32_t i = h->count; i-- > count;)
        h->elements[h->elements[i].parent].children = 0;
    h->count = count;
}

void hierarchy_renew(struct hierarchy *h)
{
    hierarchy_drop(h, h->built);
    for (uint32_t i = 0; i < h->built; i++) {
        struct element *e = &h->elements[i];
        e->child = e->children ? e->child : 0;
        e->radiosity = e->spread = e->deviation = e->reflectance = e->lower = e->gap = 0;
        e->mark = 0;
        element_reset(e);
    }
}

void hierarchy_close_up(struct hierarchy *h, uint32_t first, uint32_t *place)
{
    uint32_t kept = first;
    for (uint32_t i = 0; i < first; i++)
        place[i] = i;
    for (uint32_t i = first; i < h->count; i++) { /* children follow their parents */
        uint32_t parent = h->elements[i].parent;
        int gone = parent >= first && !place[parent];
        parent = gone ? parent : place[parent];
        place[i] = gone || !h->elements[parent].children ? 0 : kept++;
        if (!place[i])
            continue;
        struct element *e = &h->elements[place[i]], *above = &h->elements[parent];
        if (above->child == i)
            above->child = place[i];
        *e = h->elements[i];
        e->parent = parent;
    }
    h->count = kept;
}

int hierarchy_settle(struct hierarchy *h, uint32_t first, uint32_t *place)
{
    const uint32_t made = h->count - first;
    uint32_t *from = malloc((made + 1) * sizeof *from),
             n = 0; /* [new index - first]: the old one */
    struct element *moved = malloc((made + 1) * sizeof *moved);
    if (!from || !moved) {
        free(from);
        free(moved);
        return -1;
    }
    for (uint32_t i = 0; i < first; i++) {
        struct element *e = &h->elements[i];
        place[i] = i;
        if (e->child < first || !e->children)
            continue;
        const uint32_t child = e->child;
        e->child = first + n;
        for (uint32_t c = 0; c < e->children; c++)
            from[n++] = child + c;
    }
    for (uint32_t k = 0; k < n; k++) {
        const struct element *e = &h->elements[from[k]];
        place[from[k]] = first + k;
        for (uint32_t c = 0; c < e->children; c++)
            from[n++] = e->child + c;
    }
    for (uint32_t k = 0; k < n; k++) {
        struct element *e = &moved[k];
        *e = h->elements[from[k]];
        e->parent = place[e->parent];
        e->child = e->children ? place[e->child] : e->child;
    }
    memcpy(&h->elements[first], moved, n * sizeof *moved);
    free(from);
    free(moved);
    return 0;
}

void hierarchy_free(struct hierarchy *h)
{
    free(h->elements);
    free(h->face_element);
    free(h->order);
    free(h->range);
    free(h->solid);
    free(h->outer);
    free(h->plane);
    memset(h, 0, sizeof *h);
}
