/* vertex_values.c - see vertex_values.h.
 * SPDX-License-Identifier: MIT */
#include "output/vertex_values.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "geometry.h"
#include "kernel/constants.h"
#include "kernel/leaf_at.h"
#include "output/contact.h"
#include "util/array.h"

/* Where in the table the vertices at p begin. */
static uint32_t table_index(const struct vertex_values *v, const double p[3], uint32_t material)
{
    uint64_t hash = material * 0x9e3779b97f4a7c15u;
    for (int k = 0; k < 3; k++) {
        uint64_t bits;
        double positive_zero = p[k] + 0.0; /* -0 and 0 are one point */
        memcpy(&bits, &positive_zero, sizeof bits);
        hash = (hash ^ bits) * 0xbf58476d1ce4e5b9u;
        hash ^= hash >> 31;
    }
    return (uint32_t)hash & (v->table_size - 1);
}

/* On which side of what stands at the vertex the direction leads. */
static int sector_of(const struct vertex_values *v, const struct shared_vertex *s,
                     const double direction[3])
{
    return contact_sector(s->normal, s->contacts, (const double(*)[3]) & v->contact[s->contact],
                          direction);
}

/* The vertex at p that the leaf in direction `inward` (unless NULL: any) has. */
static uint32_t find_vertex(const struct vertex_values *v, const double p[3],
                            const double normal[3], uint32_t material, const double *inward)
{
    uint32_t i = v->table[table_index(v, p, material)];
    for (; i != NO_VERTEX; i = v->vertices[i].next) {
        const struct shared_vertex *s = &v->vertices[i];
        if (s->position[0] == p[0] && s->position[1] == p[1] && s->position[2] == p[2]
            && s->material == material && dot3(s->normal, normal) > OUTPUT_SAME_PLANE
            && (!inward || sector_of(v, s, inward) == s->sector))
            break;
    }
    return i;
}

/* Is p on the border of a face? What stands inside a face, or across it, parts nothing: leaves
 * lie across it, too. */
static int on_border(const struct RadFace *f, const double p[3], double touch)
{
    for (uint32_t i = 0; i < f->vertices; i++) {
        double e[3], w[3], c[3];
        sub3(e, f->vertex[i + 1 < f->vertices ? i + 1 : 0], f->vertex[i]);
        sub3(w, p, f->vertex[i]);
        cross3(c, e, w);
        if (length3(c) <= touch * length3(e))
            return 1;
    }
    return 0;
}

/* The longest distance between two corners. */
static double face_size(const struct RadFace *f)
{
    double size = 0;
    for (uint32_t i = 1; i < f->vertices; i++)
        for (uint32_t j = 0; j < i; j++) {
            double d[3];
            sub3(d, f->vertex[i], f->vertex[j]);
            size = fmax(size, length3(d));
        }
    return size;
}

static int is_corner(const struct element *e, const double p[3])
{
    for (int i = 0; i < e->vertices; i++)
        if (e->vertex[i][0] == p[0] && e->vertex[i][1] == p[1] && e->vertex[i][2] == p[2])
            return 1;
    return 0;
}

/* Note the leaves past whose edges the vertex at p lies, one in each of these faces at the most.
 * Returns 0 or -1. */
static int find_passing(struct vertex_values *v, uint32_t vertex, const struct solution *solution,
                        const struct contact *c, double touch)
{
    const double *p = v->vertices[vertex].position;
    if (array_reserve(&v->passing, (size_t)v->passing_count + CONTACT_FACES, &v->passing_capacity,
                      sizeof *v->passing)
        < 0)
        return -1;
    for (int i = 0; i < c->faces; i++) {
        const struct element *e = element_of_face(solution, c->face[i]);
        double q[3], inward[3], weight[4];
        sub3(inward, e->centre, p);
        double size = length3(inward);
        for (int k = 0; k < 3; k++)
            q[k] = p[k] + (size > touch ? touch / size : 1) * inward[k];
        uint32_t leaf =
            leaf_at(solution->tree.elements, solution->tree.face_element[c->face[i]], q, weight);
        if (!is_corner(&solution->tree.elements[leaf], p))
            v->passing[v->passing_count++] =
                (struct passing){leaf, vertex}; /* at first the vertex of any side */
    }
    return 0;
}

/* Note what parts the surface at the vertex, a corner of face f. Returns 0 or -1. */
static int find_contacts(struct vertex_values *v, uint32_t vertex, const struct solution *solution,
                         uint32_t f)
{
    struct shared_vertex *s = &v->vertices[vertex];
    double touch = CUT_TOUCH * face_size(&solution->surfaces.faces[f]);
    s->contact = v->contact_count;
    s->contacts = 0;
    if (!on_border(&solution->surfaces.faces[f], s->position, touch))
        return 0;
    struct contact c;
    contact_at(&c, solution, f, s->position, touch);
    if (c.faces > 1 && find_passing(v, vertex, solution, &c, touch))
        return -1;
    if (c.directions < 2)
        return 0;
    if (array_reserve(&v->contact, (size_t)v->contact_count + CONTACT_DIRECTIONS,
                      &v->contact_capacity, sizeof *v->contact)
        < 0)
        return -1;
    memcpy(v->contact[v->contact_count], c.direction, (size_t)c.directions * sizeof *c.direction);
    v->contact_count += (uint32_t)c.directions;
    s->contacts = (uint8_t)c.directions;
    return 0;
}

/* The vertex of corner p of leaf e, or NO_VERTEX when out of memory. */
static uint32_t find_or_add(struct vertex_values *v, const struct solution *solution,
                            const struct element *e, const double p[3])
{
    const struct RadFace *f = &solution->surfaces.faces[e->face];
    double inward[3];
    sub3(inward, e->centre, p);
    uint32_t i = find_vertex(v, p, e->normal, f->material, inward);
    if (i != NO_VERTEX)
        return i;
    uint32_t *first = &v->table[table_index(v, p, f->material)];
    uint32_t other = find_vertex(v, p, e->normal, f->material, NULL);
    struct shared_vertex *s = &v->vertices[v->count];
    memcpy(s->position, p, sizeof s->position);
    memcpy(s->normal, other == NO_VERTEX ? e->normal : v->vertices[other].normal, sizeof s->normal);
    s->material = f->material;
    if (other == NO_VERTEX) {
        if (find_contacts(v, v->count, solution, e->face))
            return NO_VERTEX;
    } else {
        s->contact = v->vertices[other].contact;
        s->contacts = v->vertices[other].contacts;
    }
    s->sector = (uint8_t)sector_of(v, s, inward);
    s->next = *first;
    s->end[0] = s->end[1] = NO_VERTEX;
    *first = v->count;
    return v->count++;
}

uint32_t vertex_values_middle(const struct vertex_values *v, uint32_t a, uint32_t b)
{
    const struct shared_vertex *s = &v->vertices[a], *t = &v->vertices[b];
    double middle[3], along[3], left[3];
    for (int k = 0; k < 3; k++)
        middle[k] = 0.5 * (s->position[k] + t->position[k]);
    sub3(along, t->position, s->position);
    cross3(left, s->normal, along);
    uint32_t m = find_vertex(v, middle, s->normal, s->material, left);
    return m == a || m == b ? NO_VERTEX : m;
}

static double edge_length(const struct vertex_values *v, uint32_t a, uint32_t b)
{
    double d[3];
    sub3(d, v->vertices[a].position, v->vertices[b].position);
    return length3(d);
}

/* Note which vertices hang on the edge a-b of a leaf, and on its halves. Returns that in the
 * middle, or NO_VERTEX. */
static uint32_t mark_hanging(struct vertex_values *v, uint32_t a, uint32_t b)
{
    uint32_t m = vertex_values_middle(v, a, b);
    if (m == NO_VERTEX)
        return m;
    uint32_t *end = v->vertices[m].end;
    if (end[0] == NO_VERTEX || edge_length(v, a, b) > edge_length(v, end[0], end[1])) {
        end[0] = a;
        end[1] = b;
    }
    mark_hanging(v, a, m);
    mark_hanging(v, m, b);
    return m;
}

/* Give a hanging vertex its value, the ends of its edge first. While a vertex waits for its ends it
 * no longer counts as hanging, so that a ring of edges, which no quadtree makes, would still
 * end. */
static void interpolate_hanging(struct vertex_values *v, uint32_t i)
{
    struct shared_vertex *s = &v->vertices[i];
    uint32_t a = s->end[0], b = s->end[1];
    if (a == NO_VERTEX)
        return;
    s->end[0] = s->end[1] = NO_VERTEX;
    interpolate_hanging(v, a);
    interpolate_hanging(v, b);
    for (uint32_t k = 0; k < v->bands; k++)
        v->value[i * v->bands + k] =
            0.5 * (v->value[a * v->bands + k] + v->value[b * v->bands + k]);
}

static int by_leaf(const void *a, const void *b)
{
    const struct passing *p = a, *q = b;
    return p->leaf != q->leaf      ? p->leaf < q->leaf ? -1 : 1
           : p->vertex < q->vertex ? -1
                                   : p->vertex > q->vertex;
}

/* Let a leaf count for the mean at a vertex, by its area. Under a solid no light arrives. */
static void add_leaf(struct vertex_values *v, const struct solution *solution, uint32_t leaf,
                     uint32_t vertex)
{
    const struct shared_vertex *at = &v->vertices[vertex];
    const double *uncovered = solution->tree.uncovered,
                 *exitance = solution->surfaces.materials[at->material].exitance;
    const int under = uncovered && !(uncovered[leaf] > 0);
    double area = solution->tree.elements[leaf].area;
    v->weight[vertex] += area;
    for (uint32_t k = 0; k < v->bands; k++)
        v->value[(size_t)vertex * v->bands + k] +=
            area * (under ? exitance[k] : radiosity_at(solution, leaf, k, at->position));
}

/* Every leaf at its corners, which makes the vertices. Returns 0 or -1. */
static int add_corners(struct vertex_values *v, const struct solution *solution)
{
    for (uint32_t i = 0; i < solution->tree.count; i++) {
        const struct element *e = &solution->tree.elements[i];
        for (uint32_t j = 0; is_leaf(e) && j < e->vertices; j++) {
            uint32_t c = find_or_add(v, solution, e, e->vertex[j]);
            if (c == NO_VERTEX)
                return -1;
            v->corner[4 * (size_t)i + j] = c;
            add_leaf(v, solution, i, c);
        }
    }
    return 0;
}

/* Every leaf at the vertices of other faces past its edges: of each, that on the leaf's side, if
 * there is one. */
static void add_passing(struct vertex_values *v, const struct solution *solution)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < v->passing_count; i++) {
        uint32_t leaf = v->passing[i].leaf;
        const struct shared_vertex *s = &v->vertices[v->passing[i].vertex];
        double inward[3];
        sub3(inward, solution->tree.elements[leaf].centre, s->position);
        uint32_t c = find_vertex(v, s->position, s->normal, s->material, inward);
        if (c == NO_VERTEX)
            continue;
        v->passing[kept++] = (struct passing){leaf, c};
        add_leaf(v, solution, leaf, c);
    }
    v->passing_count = kept;
    if (kept)
        qsort(v->passing, kept, sizeof *v->passing, by_leaf);
}

/* Hanging vertices take what the larger neighbour has on its edge. */
static void close_seams(struct vertex_values *v, const struct solution *solution)
{
    for (uint32_t i = 0; i < solution->tree.count; i++) {
        const struct element *e = &solution->tree.elements[i];
        const uint32_t *c = &v->corner[4 * (size_t)i];
        for (uint32_t j = 0; is_leaf(e) && j < e->vertices; j++)
            v->middle[4 * (size_t)i + j] =
                mark_hanging(v, c[j], c[j + 1 < e->vertices ? j + 1 : 0]);
    }
    for (uint32_t i = 0; i < v->count; i++)
        interpolate_hanging(v, i);
}

/* Room for as many vertices as leaves have corners. Returns 0 or -1. */
static int allocate(struct vertex_values *v, const struct solution *solution)
{
    size_t corners = 0, elements = solution->tree.count;
    for (size_t i = 0; i < elements; i++)
        corners += is_leaf(&solution->tree.elements[i]) ? solution->tree.elements[i].vertices : 0;
    if (corners >= NO_VERTEX / 4)
        return -1;
    while (v->table_size < corners)
        v->table_size *= 2;
    v->vertices = malloc((corners + 1) * sizeof *v->vertices);
    v->value = calloc((corners + 1) * v->bands, sizeof *v->value);
    v->weight = calloc(corners + 1, sizeof *v->weight);
    v->corner = malloc((4 * elements + 1) * sizeof *v->corner);
    v->middle = malloc((4 * elements + 1) * sizeof *v->middle);
    v->table = malloc(v->table_size * sizeof *v->table);
    if (array_reserve(&v->contact, CONTACT_DIRECTIONS, &v->contact_capacity, sizeof *v->contact)
        < 0)
        return -1;
    if (!v->vertices || !v->value || !v->weight || !v->corner || !v->middle || !v->table)
        return -1;
    memset(v->table, 0xff, v->table_size * sizeof *v->table);
    memset(v->corner, 0xff, 4 * elements * sizeof *v->corner);
    memset(v->middle, 0xff, 4 * elements * sizeof *v->middle);
    return 0;
}

int vertex_values_build(struct vertex_values *v, const struct solution *solution)
{
    *v = (struct vertex_values){.bands = solution->tree.bands, .table_size = 16};
    if (allocate(v, solution) || add_corners(v, solution)) {
        vertex_values_free(v);
        return -1;
    }
    add_passing(v, solution);
    for (uint32_t c = 0; c < v->count; c++)
        for (uint32_t k = 0; k < v->bands && v->weight[c] > 0; k++)
            v->value[(size_t)c * v->bands + k] /= v->weight[c];
    close_seams(v, solution);
    return 0;
}

void vertex_values_free(struct vertex_values *v)
{
    free(v->vertices);
    free(v->value);
    free(v->weight);
    free(v->corner);
    free(v->middle);
    free(v->table);
    free(v->contact);
    free(v->passing);
    *v = (struct vertex_values){0};
}

/* How far the value at u of the edge from a to b, in whose middle is m, is above the line between
 * its ends. */
static double above_line(const struct vertex_values *v, uint32_t a, uint32_t b, uint32_t m,
                         double u, uint32_t k)
{
    double low = v->value[(size_t)a * v->bands + k], high = v->value[(size_t)b * v->bands + k];
    double line = low + u * (high - low), from = 0, length = 1;
    while (m != NO_VERTEX) {
        double middle = v->value[(size_t)m * v->bands + k];
        length *= 0.5;
        if (u < from + length) {
            b = m;
            high = middle;
        } else {
            a = m;
            low = middle;
            from += length;
        }
        m = vertex_values_middle(v, a, b);
    }
    return low + (u - from) / length * (high - low) - line;
}

uint32_t vertex_values_at(const struct vertex_values *v, const struct solution *solution,
                          uint32_t face, const double point[3], double *radiosity)
{
    double weight[4];
    uint32_t leaf =
                 leaf_at(solution->tree.elements, solution->tree.face_element[face], point, weight),
             n = solution->tree.elements[leaf].vertices;
    const uint32_t *corner = &v->corner[4 * (size_t)leaf], *middle = &v->middle[4 * (size_t)leaf];
    for (uint32_t k = 0; k < v->bands; k++) {
        radiosity[k] = 0;
        for (uint32_t j = 0; j < n; j++)
            radiosity[k] += weight[j] * v->value[(size_t)corner[j] * v->bands + k];
        for (uint32_t j = 0; j < n; j++) {
            uint32_t next = j + 1 < n ? j + 1 : 0;
            double share = weight[j] + weight[next];
            if (middle[j] != NO_VERTEX && share > 0)
                radiosity[k] +=
                    share
                    * above_line(v, corner[j], corner[next], middle[j], weight[next] / share, k);
        }
        radiosity[k] = radiosity[k] > 0 ? radiosity[k] : 0;
    }
    return leaf;
}
