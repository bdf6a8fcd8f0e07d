/* hierarchy.c - elements from the tree of clusters, and split surfaces below the faces.
 *
 * The tree is a strategy's (bvh.h); here its nodes become elements, in the same places, with boxes, areas and cones of
 * normals. Cones are as tight as the faces allow: each cluster looks at all its faces, not at its children's
 * cones. Invariant: indices depend on the order of splits, identities (`id`) only on the path from the root, and those of faces
 * and their parts on the face alone.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "hierarchy/hierarchy.h"
#include "kernel/constants.h"
#include "kernel/hash.h"

/* What stands for a parent in the identities of faces, wherever the clusters put them. */
#define FACES 0x2545f4914f6cdd1du

static uint64_t child_id(uint64_t parent, uint32_t k)
{
    return hash64(parent * 4 + k + HASH_STEP);
}

/* Area, centroid, unit normal and radius from the corners. */
static void measure_surface(struct element *e)
{
    double normal[3] = { 0, 0, 0 }, sum[3] = { 0, 0, 0 }, area = 0, size, farthest = 0;
    int i, k;
    for (i = 2; i < e->vertices; i++) {
        double a[3], b[3], c[3];
        sub3(a, e->vertex[i - 1], e->vertex[0]);
        sub3(b, e->vertex[i], e->vertex[0]);
        cross3(c, a, b);
        for (k = 0; k < 3; k++)
            normal[k] += c[k];
    }
    size = length3(normal);
    for (k = 0; k < 3; k++)
        e->normal[k] = size > 0 ? normal[k] / size : 0;
    for (i = 2; i < e->vertices; i++) {
        double a[3], b[3], c[3], part;
        sub3(a, e->vertex[i - 1], e->vertex[0]);
        sub3(b, e->vertex[i], e->vertex[0]);
        cross3(c, a, b);
        part = 0.5 * dot3(c, e->normal);
        area += part;
        for (k = 0; k < 3; k++)
            sum[k] += part * (a[k] + b[k]) * (1 / 3.0);
    }
    e->area = area;
    for (k = 0; k < 3; k++)
        e->centre[k] = e->vertex[0][k] + (area > 0 ? sum[k] / area : 0);
    for (i = 0; i < e->vertices; i++) {
        double a[3], q;
        sub3(a, e->vertex[i], e->centre);
        q = dot3(a, a);
        farthest = q > farthest ? q : farthest;
    }
    e->radius = sqrt(farthest);
    e->cone = 1;
}

void element_reset(struct element *e)
{
    e->importance = 1;
    e->allowance = INFINITY;
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
    measure_surface(e);
    element_reset(e);
}

void element_measure_cluster(struct element *e, const struct face_share *share, const struct bounds *box, struct face_range range)
{
    double axis[3] = { 0, 0, 0 }, size;
    uint32_t i;
    int k;
    element_reset(e);
    e->black = 1;
    for (i = range.from; i < range.to; i++) {
        const struct face_share *s = &share[i];
        e->area += s->area;
        e->black = e->black && s->black;
        for (k = 0; k < 3; k++)
            axis[k] += s->area * s->normal[k];
    }
    size = length3(axis);
    e->cone = size > CONE_LEAST * e->area ? 1 : -1;
    for (k = 0; k < 3; k++)
        e->normal[k] = size > 0 ? axis[k] / size : 0;
    for (i = range.from; i < range.to && e->cone > -1; i++) {
        double c = dot3(share[i].normal, e->normal);
        if (c < 1 - CONE_EQUAL && c < e->cone)
            e->cone = c;
    }
    for (k = 0; k < 3; k++) {
        e->centre[k] = 0.5 * (box->low[k] + box->high[k]);
        e->vertex[0][k] = box->low[k];
        e->vertex[1][k] = box->high[k];
    }
    sub3(axis, box->high, box->low);
    e->radius = 0.5 * length3(axis);
}

static int reserve(struct hierarchy *h, uint32_t more)
{
    uint64_t need = (uint64_t)h->count + more, capacity = h->capacity;
    struct element *moved;
    if (need <= capacity)
        return 0;
    capacity = need + need / 2;
    if (capacity > UINT32_MAX)
        capacity = UINT32_MAX;
    if (need > capacity)
        return -1;
    moved = realloc(h->elements, (size_t)capacity * sizeof *moved);
    if (!moved)
        return -1;
    h->elements = moved;
    h->capacity = (uint32_t)capacity;
    return 0;
}

/* Parents, children, identities: from the root down. */
static void place_elements(struct hierarchy *h, const struct cluster_tree *t)
{
    uint32_t i, k;
    memset(h->elements, 0, t->count * sizeof *h->elements);
    h->elements[0].id = child_id(0, 0);
    for (i = 0; i < t->count; i++) {
        const struct cluster_node *n = &t->nodes[i];
        struct element *e = &h->elements[i];
        h->range[i] = (struct face_range){ n->from, n->to };
        e->child = n->child;
        e->children = (uint8_t)n->children;
        for (k = 0; k < n->children; k++) {
            h->elements[n->child + k].parent = i;
            h->elements[n->child + k].id = child_id(e->id, k);
        }
    }
}

int hierarchy_build_by(struct hierarchy *h, const struct face *faces, uint32_t face_count, enum clustering strategy, int threads)
{
    struct cluster_tree t;
    struct face_share *share = NULL;
    uint32_t i;
    int result = -1;
    memset(h, 0, sizeof *h);
    if (cluster_tree_build(&t, faces, face_count, strategy, threads) < 0)
        return -1;
    h->faces = faces;
    h->face_count = face_count;
    h->face_element = malloc(face_count * sizeof *h->face_element);
    h->range = malloc(t.count * sizeof *h->range);
    share = malloc(face_count * sizeof *share);
    if (!h->face_element || !h->range || !share || reserve(h, t.count) < 0)
        goto done;
    h->count = h->built = t.count;
    memcpy(h->low, t.boxes[0].low, sizeof h->low);
    memcpy(h->high, t.boxes[0].high, sizeof h->high);
    place_elements(h, &t);
#pragma omp parallel for schedule(static) num_threads(threads)
    for (i = 0; i < t.count; i++) {
        const struct element *e = &h->elements[i];
        struct face_share *s = &share[t.nodes[i].from];
        if (t.nodes[i].children)
            continue;
        make_face(h, i, t.order[t.nodes[i].from]);
        memcpy(s->normal, e->normal, sizeof s->normal);
        s->area = e->area;
        s->black = e->black;
    }
#pragma omp parallel for schedule(dynamic, 64) num_threads(threads)
    for (i = 0; i < t.count; i++)
        if (t.nodes[i].children)
            element_measure_cluster(&h->elements[i], share, &t.boxes[i], h->range[i]);
    h->order = t.order;
    t.order = NULL;
    result = 0;
done:
    free(share);
    cluster_tree_free(&t);
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
    double mid[4][3], middle[3];
    uint32_t first = h->count;
    int i, k, n;
    if (h->elements[element].children)
        return 0;
    if (reserve(h, 4) < 0)
        return -1;
    {
        struct element *e = &h->elements[element];
        n = e->vertices;
        for (i = 0; i < n; i++)
            for (k = 0; k < 3; k++)
                mid[i][k] = 0.5 * (e->vertex[i][k] + e->vertex[i + 1 < n ? i + 1 : 0][k]);
        for (k = 0; k < 3; k++)
            middle[k] = 0.5 * (mid[0][k] + mid[2][k]);
        for (i = 0; i < 4; i++) {
            struct element *c = &h->elements[first + (uint32_t)i];
            memset(c, 0, sizeof *c);
            for (k = 0; k < 3; k++) {
                if (n == 3 && i == 3) { /* the triangle between the midpoints */
                    c->vertex[0][k] = mid[0][k];
                    c->vertex[1][k] = mid[1][k];
                    c->vertex[2][k] = mid[2][k];
                } else { /* child i keeps corner i */
                    int before = i > 0 ? i - 1 : n - 1;
                    c->vertex[i][k] = e->vertex[i][k];
                    c->vertex[i + 1 < n ? i + 1 : 0][k] = mid[i][k];
                    c->vertex[before][k] = mid[before][k];
                    if (n == 4)
                        c->vertex[(i + 2) % 4][k] = middle[k];
                }
            }
            c->vertices = e->vertices;
            c->face = e->face;
            c->black = e->black;
            c->depth = (uint8_t)(e->depth + 1);
            c->parent = element;
            c->radiosity = e->radiosity;
            c->reflectance = e->reflectance;
            c->importance = e->importance;
            c->allowance = e->allowance;
            c->id = child_id(e->id, (uint32_t)i);
            measure_surface(c);
            memcpy(c->normal, e->normal, sizeof c->normal);
        }
        e->child = first;
        e->children = 4;
    }
    h->count += 4;
    return 0;
}

void hierarchy_free(struct hierarchy *h)
{
    free(h->elements);
    free(h->face_element);
    free(h->order);
    free(h->range);
    free(h->solid);
    memset(h, 0, sizeof *h);
}
