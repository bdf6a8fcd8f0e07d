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

/* Where on the polygon's border, corner by corner, vertex c lies: between `*at` and the next.
 * Returns 0 when it is a corner. */
static int edge_of(const struct leaf_mesh *m, const struct vertex_values *v, uint32_t from,
                   uint32_t c, uint32_t *at)
{
    const double *p = v->vertices[c].position;
    double nearest = INFINITY;
    for (uint32_t j = from; j < m->corners; j++) {
        const double *a = v->vertices[m->corner[j]].position,
                     *b = v->vertices[m->corner[j + 1 < m->corners ? j + 1 : from]].position;
        double e[3], x[3], y[3];
        if (m->corner[j] == c)
            return 0;
        sub3(e, b, a);
        sub3(x, p, a);
        sub3(y, b, p);
        double detour = (length3(x) + length3(y)) / length3(e);
        if (detour < nearest) {
            nearest = detour;
            *at = j;
        }
    }
    return 1;
}

/* Put the vertices of other faces that lie on the leaf's edges into the last polygon, which
 * begins at `from`. */
static int push_passing(struct leaf_mesh *m, const struct vertex_values *v, uint32_t leaf,
                        uint32_t from)
{
    uint32_t low = 0, high = v->passing_count, at = from;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (v->passing[middle].leaf < leaf)
            low = middle + 1;
        else
            high = middle;
    }
    for (; low < v->passing_count && v->passing[low].leaf == leaf; low++) {
        if (!edge_of(m, v, from, v->passing[low].vertex, &at))
            continue;
        if (push_number(&m->corner, &m->corners, &m->corner_capacity, 0))
            return -1;
        memmove(&m->corner[at + 2], &m->corner[at + 1], (m->corners - at - 2) * sizeof *m->corner);
        m->corner[at + 1] = v->passing[low].vertex;
    }
    return 0;
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
        for (uint32_t j = 0; j < e->vertices && !failed; j++)
            failed |= push_edge(m, values, c[j], c[j + 1 < e->vertices ? j + 1 : 0]);
        failed = failed || push_passing(m, values, i, m->start[m->polygons - 1]);
    }
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
