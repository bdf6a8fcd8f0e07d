/* leaf_mesh.c - see leaf_mesh.h.
 * SPDX-License-Identifier: MIT */
#include "output/leaf_mesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "geometry.h"
#include "hierarchy/polygon.h"

static int push(uint32_t **array, uint32_t *count, uint32_t *capacity, uint32_t value)
{
    if (*count == *capacity) {
        uint32_t more = *capacity < 1024 ? 1024 : *capacity > UINT32_MAX / 2 ? UINT32_MAX : *capacity * 2;
        uint32_t *larger = more > *count ? realloc(*array, more * sizeof *larger) : NULL;
        if (!larger)
            return -1;
        *array = larger;
        *capacity = more;
    }
    (*array)[(*count)++] = value;
    return 0;
}

/* Vertex a, then what hangs between a and b. */
static int push_edge(struct leaf_mesh *m, const struct vertex_values *v, uint32_t a, uint32_t b)
{
    uint32_t middle = vertex_values_middle(v, a, b);
    if (middle == NO_VERTEX)
        return push(&m->corner, &m->corners, &m->corner_capacity, a);
    return push_edge(m, v, a, middle) || push_edge(m, v, middle, b) ? -1 : 0;
}

/* Where on the polygon's border, corner by corner, vertex c lies: between `*at` and the next. Returns 0 when it is a corner. */
static int edge_of(const struct leaf_mesh *m, const struct vertex_values *v, uint32_t from, uint32_t c, uint32_t *at)
{
    const double *p = v->vertices[c].position;
    double nearest = INFINITY;
    for (uint32_t j = from; j < m->corners; j++) {
        const double *a = v->vertices[m->corner[j]].position, *b = v->vertices[m->corner[j + 1 < m->corners ? j + 1 : from]].position;
        double e[3], x[3], y[3], detour;
        if (m->corner[j] == c)
            return 0;
        sub3(e, b, a);
        sub3(x, p, a);
        sub3(y, b, p);
        detour = (length3(x) + length3(y)) / length3(e);
        if (detour < nearest) {
            nearest = detour;
            *at = j;
        }
    }
    return 1;
}

/* Put the vertices of other faces that lie on the leaf's edges into the last polygon, which begins at `from`. */
static int push_passing(struct leaf_mesh *m, const struct vertex_values *v, uint32_t leaf, uint32_t from)
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
        if (push(&m->corner, &m->corners, &m->corner_capacity, 0))
            return -1;
        memmove(&m->corner[at + 2], &m->corner[at + 1], (m->corners - at - 2) * sizeof *m->corner);
        m->corner[at + 1] = v->passing[low].vertex;
    }
    return 0;
}

/* One start more: where the last polygon ends. */
static int finish(struct leaf_mesh *m, int failed)
{
    if (failed || push(&m->start, &m->polygons, &m->polygon_capacity, m->corners)) {
        leaf_mesh_free(m);
        return -1;
    }
    m->polygons--;
    return 0;
}

int leaf_mesh_build(struct leaf_mesh *m, const struct solution *solution, const struct vertex_values *values)
{
    const struct hierarchy *h = solution->hierarchy;
    int failed = 0;
    *m = (struct leaf_mesh){0};
    for (uint32_t i = 0; i < h->count && !failed; i++) {
        const struct element *e = &h->elements[i];
        if (!e->vertices || e->children)
            continue;
        const uint32_t *c = &values->corner[4 * (size_t)i];
        failed |= push(&m->start, &m->polygons, &m->polygon_capacity, m->corners);
        for (uint32_t j = 0; j < e->vertices && !failed; j++)
            failed |= push_edge(m, values, c[j], c[j + 1 < e->vertices ? j + 1 : 0]);
        failed = failed || push_passing(m, values, i, m->start[m->polygons - 1]);
    }
    return finish(m, failed);
}

int leaf_mesh_triangulate(struct leaf_mesh *m, const struct vertex_values *values)
{
    struct leaf_mesh out = {0};
    uint32_t most = 3, *scratch = NULL, (*triangle)[3] = NULL;
    double (*position)[3] = NULL;
    for (uint32_t i = 0; i < m->polygons; i++)
        most = m->start[i + 1] - m->start[i] > most ? m->start[i + 1] - m->start[i] : most;
    scratch = malloc(most * sizeof *scratch);
    triangle = malloc(most * sizeof *triangle);
    position = malloc(most * sizeof *position);
    int failed = !scratch || !triangle || !position;
    for (uint32_t i = 0; i < m->polygons && !failed; i++) {
        uint32_t n = m->start[i + 1] - m->start[i];
        const uint32_t *corner = &m->corner[m->start[i]];
        for (uint32_t j = 0; j < n; j++)
            memcpy(position[j], values->vertices[corner[j]].position, sizeof position[j]);
        uint32_t triangles = polygon_triangulate(position, n, triangle, scratch);
        for (uint32_t j = 0; j < triangles && !failed; j++) {
            failed |= push(&out.start, &out.polygons, &out.polygon_capacity, out.corners);
            for (int k = 0; k < 3; k++)
                failed |= push(&out.corner, &out.corners, &out.corner_capacity, corner[triangle[j][k]]);
        }
    }
    free(scratch);
    free(triangle);
    free(position);
    failed = finish(&out, failed);
    leaf_mesh_free(m);
    *m = out;
    return failed;
}

void leaf_mesh_free(struct leaf_mesh *m)
{
    free(m->corner);
    free(m->start);
    *m = (struct leaf_mesh){0};
}
