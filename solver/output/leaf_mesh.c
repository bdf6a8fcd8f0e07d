/* leaf_mesh.c - see leaf_mesh.h.
 *
 * Leaves are convex, so that triangles are cut off without looking whether another corner lies
 * within.
 * SPDX-License-Identifier: MIT */
#include "output/leaf_mesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "geometry.h"
#include "util/array.h"

/* Of a leaf's area: triangles below it are straight lines, bent by rounding. */
static const double MESH_STRAIGHT = 1e-9;

static int push_number(uint32_t **array, uint32_t *count, size_t *capacity, uint32_t value)
{
    if (*count == UINT32_MAX
        || array_reserve(array, (size_t)*count + 1, capacity, sizeof **array) < 0)
        return -1;
    (*array)[(*count)++] = value;
    return 0;
}

/* Vertex a, then what hangs between a and b. */
static int push_edge(struct leaf_mesh *m, const struct vertex_values *v, uint32_t a, uint32_t b)
{
    uint32_t middle = vertex_values_middle(v, a, b);
    if (middle == NO_VERTEX)
        return push_number(&m->corner, &m->corners, &m->corner_capacity, a);
    return push_edge(m, v, a, middle) || push_edge(m, v, middle, b) ? -1 : 0;
}

/* A point on a leaf's border: so far along that side; of points in one place the first to come. */
struct border_point {
    double along; /* in lengths of the side */
    uint32_t side, order, vertex;
};

struct border {
    struct border_point *points; /* [count] */
    uint32_t count;
    size_t capacity;
};

static int by_vertex(const void *a, const void *b)
{
    const struct border_point *p = a, *q = b;
    return p->vertex != q->vertex ? p->vertex < q->vertex ? -1 : 1
           : p->order < q->order  ? -1
                                  : p->order > q->order;
}

static int by_place(const void *a, const void *b)
{
    const struct border_point *p = a, *q = b;
    return p->side != q->side     ? p->side < q->side ? -1 : 1
           : p->along != q->along ? p->along < q->along ? -1 : 1
           : p->order < q->order  ? -1
                                  : p->order > q->order;
}

/* Where the vertex is along the side from a to b. Returns how much longer the way past it is than
 * the side. */
static double measure_along(const struct vertex_values *v, uint32_t a, uint32_t b, uint32_t vertex,
                            double *along)
{
    const double *p = v->vertices[vertex].position;
    double e[3], x[3], y[3];
    sub3(e, v->vertices[b].position, v->vertices[a].position);
    sub3(x, p, v->vertices[a].position);
    sub3(y, v->vertices[b].position, p);
    *along = dot3(e, e) > 0 ? fmax(dot3(x, e) / dot3(e, e), 0) : 0;
    return (length3(x) + length3(y)) / length3(e);
}

static int push_point(struct border *b, uint32_t vertex, uint32_t side, double along)
{
    if (array_reserve(&b->points, (size_t)b->count + 1, &b->capacity, sizeof *b->points) < 0)
        return -1;
    b->points[b->count] = (struct border_point){along, side, b->count, vertex};
    b->count++;
    return 0;
}

/* A vertex on the nearest of the leaf's sides. */
static int push_on_side(struct border *b, const struct vertex_values *v, const uint32_t *c,
                        uint32_t sides, uint32_t vertex)
{
    double nearest = INFINITY, along = 0;
    uint32_t side = 0;
    for (uint32_t j = 0; j < sides; j++) {
        double here, detour = measure_along(v, c[j], c[(j + 1) % sides], vertex, &here);
        if (detour < nearest) {
            nearest = detour;
            along = here;
            side = j;
        }
    }
    return push_point(b, vertex, side, along);
}

/* Put the vertices of other faces that lie on the leaf's sides into the last polygon, whose sides
 * begin at first[0 .. sides]. Any number of them may lie on one. */
static int push_passing(struct leaf_mesh *m, const struct vertex_values *v, uint32_t leaf,
                        uint32_t sides, const uint32_t *first, struct border *b)
{
    const uint32_t *c = &v->corner[4 * (size_t)leaf];
    uint32_t low = 0, high = v->passing_count, kept = 0;
    int failed = 0;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (v->passing[middle].leaf < leaf)
            low = middle + 1;
        else
            high = middle;
    }
    if (low == v->passing_count || v->passing[low].leaf != leaf)
        return 0;
    b->count = 0;
    for (uint32_t j = 0; j < sides; j++)
        for (uint32_t i = first[j]; i < first[j + 1] && !failed; i++) {
            double along;
            (void)measure_along(v, c[j], c[(j + 1) % sides], m->corner[i], &along);
            failed = push_point(b, m->corner[i], j, along);
        }
    for (; low < v->passing_count && v->passing[low].leaf == leaf && !failed; low++)
        failed = push_on_side(b, v, c, sides, v->passing[low].vertex);
    if (failed)
        return -1;
    qsort(b->points, b->count, sizeof *b->points, by_vertex);
    for (uint32_t i = 0; i < b->count; i++)
        if (!kept || b->points[kept - 1].vertex != b->points[i].vertex)
            b->points[kept++] = b->points[i];
    qsort(b->points, kept, sizeof *b->points, by_place);
    m->corners = first[0];
    for (uint32_t i = 0; i < kept && !failed; i++)
        failed = push_number(&m->corner, &m->corners, &m->corner_capacity, b->points[i].vertex);
    return failed;
}

/* One start more: where the last polygon ends. */
static int finish(struct leaf_mesh *m, int failed)
{
    if (failed || push_number(&m->start, &m->polygons, &m->polygon_capacity, m->corners)) {
        leaf_mesh_free(m);
        return -1;
    }
    m->polygons--;
    return 0;
}

int leaf_mesh_build(struct leaf_mesh *m, const struct solution *solution,
                    const struct vertex_values *values)
{
    struct border border = {0};
    int failed = 0;
    *m = (struct leaf_mesh){0};
    for (uint32_t i = 0; i < solution->tree.count && !failed; i++) {
        const struct element *e = &solution->tree.elements[i];
        if (!is_leaf(e))
            continue;
        const uint32_t *c = &values->corner[4 * (size_t)i];
        failed |= push_number(&m->start, &m->polygons, &m->polygon_capacity, m->corners)
                  || push_number(&m->material, &m->materials, &m->material_capacity,
                                 solution->surfaces.faces[e->face].material);
        const uint32_t sides = (uint32_t)e->vertices;
        uint32_t first[5] = {m->corners};
        for (uint32_t j = 0; j < sides && !failed; j++) {
            failed |= push_edge(m, values, c[j], c[(j + 1) % sides]);
            first[j + 1] = m->corners;
        }
        failed = failed || push_passing(m, values, i, sides, first, &border);
    }
    free(border.points);
    return finish(m, failed);
}

/* Twice the area of the triangle of three vertices. */
static double twice_area(const struct vertex_values *v, const uint32_t corner[3])
{
    double a[3], b[3], c[3];
    sub3(a, v->vertices[corner[1]].position, v->vertices[corner[0]].position);
    sub3(b, v->vertices[corner[2]].position, v->vertices[corner[0]].position);
    cross3(c, a, b);
    return length3(c);
}

/* Corner i of the ring, the one before it and the one behind it. */
static void ear_at(const uint32_t *ring, uint32_t count, uint32_t i, uint32_t ear[3])
{
    ear[0] = ring[i ? i - 1 : count - 1];
    ear[1] = ring[i];
    ear[2] = ring[i + 1 < count ? i + 1 : 0];
}

/* The ear of a convex ring of that area with the shortest cut. Straight corners are no ears, and
 * neither is one that would leave only a straight rest: the vertices in it would be lost. Returns
 * `count` when there is none. */
static uint32_t best_ear(const struct vertex_values *v, const uint32_t *ring, uint32_t count,
                         double area)
{
    uint32_t best = count, ear[3];
    double shortest = INFINITY, least = MESH_STRAIGHT * area;
    for (uint32_t i = 0; i < count; i++) {
        double cut[3];
        ear_at(ring, count, i, ear);
        double own = twice_area(v, ear);
        sub3(cut, v->vertices[ear[2]].position, v->vertices[ear[0]].position);
        if (own > least && own < area - least && length3(cut) < shortest) {
            shortest = length3(cut);
            best = i;
        }
    }
    return best;
}

/* Push the triangles of a leaf: convex, with vertices of neighbours on its straight edges.
 * `ring` is used up. */
static int push_triangles(struct leaf_mesh *m, const struct vertex_values *v, uint32_t *ring,
                          uint32_t count, uint32_t material)
{
    double area = 0;
    int failed = 0;
    for (uint32_t i = 2; i < count; i++)
        area += twice_area(v, (const uint32_t[3]){ring[0], ring[i - 1], ring[i]});
    while (count >= 3 && !failed) {
        uint32_t ear[3], i = count == 3 ? 1 : best_ear(v, ring, count, area);
        if (i == count)
            break; /* no area to speak of */
        ear_at(ring, count, i, ear);
        area -= twice_area(v, ear);
        memmove(&ring[i], &ring[i + 1], (count - i - 1) * sizeof *ring);
        count--;
        failed |= push_number(&m->start, &m->polygons, &m->polygon_capacity, m->corners)
                  || push_number(&m->material, &m->materials, &m->material_capacity, material);
        for (int k = 0; k < 3; k++)
            failed |= push_number(&m->corner, &m->corners, &m->corner_capacity, ear[k]);
    }
    return failed;
}

int leaf_mesh_triangulate(struct leaf_mesh *m, const struct vertex_values *values)
{
    struct leaf_mesh out = {0};
    int failed = 0;
    for (uint32_t i = 0; i < m->polygons && !failed; i++)
        failed = push_triangles(&out, values, &m->corner[m->start[i]],
                                m->start[i + 1] - m->start[i], m->material[i]);
    failed = finish(&out, failed);
    leaf_mesh_free(m);
    *m = out;
    return failed;
}

void leaf_mesh_free(struct leaf_mesh *m)
{
    free(m->corner);
    free(m->start);
    free(m->material);
    *m = (struct leaf_mesh){0};
}
