/* vertex_values.c - see vertex_values.h.
 * SPDX-License-Identifier: MIT */
#include "output/vertex_values.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "output/contact.h"
#include "geometry.h"
#include "hierarchy/polygon.h"

static const double SAME_PLANE = 0.99985; /* cosine of one degree */
static const double TOUCH = 1e-4;         /* of a face's size: nearer than that to it stands on it, as in scene_cut.c */

static int is_leaf(const struct element *e)
{
    return e->vertices && !e->children;
}

/* The two axes in which a plane of this normal is widest. */
static void widest_axes(const double normal[3], int *x, int *y)
{
    double a = fabs(normal[0]), b = fabs(normal[1]), c = fabs(normal[2]);
    *x = a >= b && a >= c ? 1 : 0;
    *y = c > a && c > b ? 1 : 2;
}

static double clamp(double t)
{
    return t > 0 ? (t < 1 ? t : 1) : 0; /* NaN becomes 0 */
}

/* Distance of t from [0, 1]. */
static double outside(double t)
{
    return t < 0 ? -t : t > 1 ? t - 1 : 0;
}

/* Solve p = v0 + s (v1 - v0) + t (v3 - v0) + s t (v0 - v1 + v2 - v3), a quadratic in t. */
static void quad_parameters(const struct element *e, const double p[3], double *s, double *t)
{
    int x, y;
    widest_axes(e->normal, &x, &y);
    double ex = e->vertex[1][x] - e->vertex[0][x], ey = e->vertex[1][y] - e->vertex[0][y];
    double fx = e->vertex[3][x] - e->vertex[0][x], fy = e->vertex[3][y] - e->vertex[0][y];
    double gx = e->vertex[2][x] - e->vertex[1][x] - fx, gy = e->vertex[2][y] - e->vertex[1][y] - fy;
    double hx = p[x] - e->vertex[0][x], hy = p[y] - e->vertex[0][y];
    double a = gx * fy - gy * fx, b = ex * fy - ey * fx + hx * gy - hy * gx, c = hx * ey - hy * ex;
    double d = sqrt(fmax(b * b - 4 * a * c, 0)), q = -0.5 * (b + copysign(d, b));
    /* q / a overflows when the sides are parallel; then c / q is the root. */
    double root = c / q, other = q / a;
    *t = outside(root) <= 1e-9 || !(outside(other) < outside(root)) ? clamp(root) : clamp(other);
    double wx = ex + gx * *t, wy = ey + gy * *t;
    *s = clamp(fabs(wx) > fabs(wy) ? (hx - fx * *t) / wx : (hy - fy * *t) / wy);
}

static void triangle_parameters(const struct element *e, const double p[3], double weight[3])
{
    int x, y;
    widest_axes(e->normal, &x, &y);
    double ax = e->vertex[1][x] - e->vertex[0][x], ay = e->vertex[1][y] - e->vertex[0][y];
    double bx = e->vertex[2][x] - e->vertex[0][x], by = e->vertex[2][y] - e->vertex[0][y];
    double hx = p[x] - e->vertex[0][x], hy = p[y] - e->vertex[0][y], area = ax * by - ay * bx;
    weight[1] = clamp((hx * by - hy * bx) / area);
    weight[2] = clamp((ax * hy - ay * hx) / area);
    if (weight[1] + weight[2] > 1) {
        double sum = weight[1] + weight[2];
        weight[1] /= sum;
        weight[2] /= sum;
    }
    weight[0] = 1 - weight[1] - weight[2];
}

/* Halving a quad halves its bilinear parameters: the cuts are lines of s = 1/2 and t = 1/2, and a
 * child numbers its corners as its parent does. */
static uint32_t descend_quad(const struct hierarchy *h, uint32_t i, const double p[3], double weight[4])
{
    double s, t;
    quad_parameters(&h->elements[i], p, &s, &t);
    while (h->elements[i].children) {
        int right = s > 0.5, top = t > 0.5;
        i = h->elements[i].child + (uint32_t)(top ? (right ? 2 : 3) : (right ? 1 : 0));
        s = 2 * s - right;
        t = 2 * t - top;
    }
    weight[0] = (1 - s) * (1 - t);
    weight[1] = s * (1 - t);
    weight[2] = s * t;
    weight[3] = (1 - s) * t;
    return i;
}

/* Child k keeps corner k; child 3 is the middle, its corners those between 0-1, 1-2, 2-0. */
static uint32_t descend_triangle(const struct hierarchy *h, uint32_t i, const double p[3], double weight[4])
{
    triangle_parameters(&h->elements[i], p, weight);
    while (h->elements[i].children) {
        uint32_t k = weight[0] > 0.5 ? 0 : weight[1] > 0.5 ? 1 : weight[2] > 0.5 ? 2 : 3;
        i = h->elements[i].child + k;
        if (k < 3) {
            for (uint32_t j = 0; j < 3; j++)
                weight[j] = 2 * weight[j] - (j == k);
        } else {
            double w0 = 1 - 2 * weight[2], w1 = 1 - 2 * weight[0], w2 = 1 - 2 * weight[1];
            weight[0] = w0;
            weight[1] = w1;
            weight[2] = w2;
        }
    }
    return i;
}

static uint32_t descend(const struct hierarchy *h, uint32_t face, const double p[3], double weight[4])
{
    uint32_t root = h->face_element[face];
    return h->elements[root].vertices == 4 ? descend_quad(h, root, p, weight) : descend_triangle(h, root, p, weight);
}

static uint32_t place(const struct vertex_values *v, const double p[3], uint32_t material)
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

/* The vertex at p that the leaf in direction `inward` (unless NULL: any) has. */
static uint32_t find(const struct vertex_values *v, const double p[3], const double normal[3], uint32_t material, const double *inward)
{
    uint32_t i = v->table[place(v, p, material)];
    for (; i != NO_VERTEX; i = v->vertices[i].next) {
        const struct shared_vertex *s = &v->vertices[i];
        if (s->position[0] == p[0] && s->position[1] == p[1] && s->position[2] == p[2] &&
            s->material == material && dot3(s->normal, normal) > SAME_PLANE
            && (!inward || contact_sector(s->normal, s->contacts, (const double (*)[3])&v->contact[s->contact], inward) == s->sector))
            break;
    }
    return i;
}

/* Is p on the border of a face? What stands inside a face, or across it, parts nothing: leaves lie across it, too. */
static int on_border(const struct face *f, const double p[3], double touch)
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

/* The array, with room for `count` more of `size`; NULL when there is none. */
static void *enlarge(void *array, uint32_t have, uint32_t *capacity, uint32_t count, size_t size)
{
    uint32_t more = 2 * *capacity + 16 * count;
    if (have + count <= *capacity)
        return array;
    void *moved = realloc(array, more * size);
    if (moved)
        *capacity = more;
    return moved;
}

static int is_corner(const struct element *e, const double p[3])
{
    for (int i = 0; i < e->vertices; i++)
        if (e->vertex[i][0] == p[0] && e->vertex[i][1] == p[1] && e->vertex[i][2] == p[2])
            return 1;
    return 0;
}

/* Note the leaves past whose edges the vertex at p lies, one in each of these faces at the most. Returns 0 or -1. */
static int find_passing(struct vertex_values *v, uint32_t vertex, const struct hierarchy *h, const struct contact *c, double touch)
{
    const double *p = v->vertices[vertex].position;
    struct passing *moved = enlarge(v->passing, v->passing_count, &v->passing_capacity, CONTACT_FACES, sizeof *moved);
    if (!moved)
        return -1;
    v->passing = moved;
    for (int i = 0; i < c->faces; i++) {
        const struct element *e = &h->elements[h->face_element[c->face[i]]];
        double q[3], inward[3], weight[4], size;
        sub3(inward, e->centre, p);
        size = length3(inward);
        for (int k = 0; k < 3; k++)
            q[k] = p[k] + (size > touch ? touch / size : 1) * inward[k];
        uint32_t leaf = descend(h, c->face[i], q, weight);
        if (!is_corner(&h->elements[leaf], p))
            v->passing[v->passing_count++] = (struct passing){ leaf, vertex }; /* at first the vertex of any side */
    }
    return 0;
}

/* Note what parts the surface at the vertex, a corner of face f. Returns 0 or -1. */
static int find_contacts(struct vertex_values *v, uint32_t vertex, const struct hierarchy *h, uint32_t f)
{
    struct shared_vertex *s = &v->vertices[vertex];
    struct contact c;
    double corner[4][3], touch;
    memcpy(corner, h->faces[f].vertex, sizeof corner);
    touch = TOUCH * polygon_size(corner, h->faces[f].vertices);
    s->contact = v->contact_count;
    s->contacts = 0;
    if (!on_border(&h->faces[f], s->position, touch))
        return 0;
    contact_at(&c, h, f, s->position, touch);
    if (c.faces > 1 && find_passing(v, vertex, h, &c, touch))
        return -1;
    if (c.directions < 2)
        return 0;
    double (*moved)[3] = enlarge(v->contact, v->contact_count, &v->contact_capacity, CONTACT_DIRECTIONS, sizeof *moved);
    if (!moved)
        return -1;
    v->contact = moved;
    memcpy(v->contact[v->contact_count], c.direction, (size_t)c.directions * sizeof *c.direction);
    v->contact_count += (uint32_t)c.directions;
    s->contacts = (uint8_t)c.directions;
    return 0;
}

/* The vertex of corner p of leaf e, or NO_VERTEX when out of memory. */
static uint32_t find_or_add(struct vertex_values *v, const struct hierarchy *h, const struct element *e, const double p[3])
{
    const struct face *f = &h->faces[e->face];
    double inward[3];
    sub3(inward, e->centre, p);
    uint32_t i = find(v, p, e->normal, f->material, inward);
    if (i != NO_VERTEX)
        return i;
    uint32_t *first = &v->table[place(v, p, f->material)], other = find(v, p, e->normal, f->material, NULL);
    struct shared_vertex *s = &v->vertices[v->count];
    memcpy(s->position, p, sizeof s->position);
    memcpy(s->normal, other == NO_VERTEX ? e->normal : v->vertices[other].normal, sizeof s->normal);
    s->material = f->material;
    if (other == NO_VERTEX) {
        if (find_contacts(v, v->count, h, e->face))
            return NO_VERTEX;
    } else {
        s->contact = v->vertices[other].contact;
        s->contacts = v->vertices[other].contacts;
    }
    s->sector = (uint8_t)contact_sector(s->normal, s->contacts, (const double (*)[3])&v->contact[s->contact], inward);
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
    uint32_t m = find(v, middle, s->normal, s->material, left);
    return m == a || m == b ? NO_VERTEX : m;
}

static double edge_length(const struct vertex_values *v, uint32_t a, uint32_t b)
{
    double d[3];
    sub3(d, v->vertices[a].position, v->vertices[b].position);
    return length3(d);
}

/* Note which vertices hang on the edge a-b of a leaf, and on its halves. */
static void mark_hanging(struct vertex_values *v, uint32_t a, uint32_t b)
{
    uint32_t m = vertex_values_middle(v, a, b);
    if (m == NO_VERTEX)
        return;
    uint32_t *end = v->vertices[m].end;
    if (end[0] == NO_VERTEX || edge_length(v, a, b) > edge_length(v, end[0], end[1])) {
        end[0] = a;
        end[1] = b;
    }
    mark_hanging(v, a, m);
    mark_hanging(v, m, b);
}

/* Give a hanging vertex its value, the ends of its edge first. While a vertex waits for its ends it
 * no longer counts as hanging, so that a ring of edges, which no quadtree makes, would still end. */
static void settle(struct vertex_values *v, uint32_t i)
{
    struct shared_vertex *s = &v->vertices[i];
    uint32_t a = s->end[0], b = s->end[1];
    if (a == NO_VERTEX)
        return;
    s->end[0] = s->end[1] = NO_VERTEX;
    settle(v, a);
    settle(v, b);
    for (uint32_t k = 0; k < v->bands; k++)
        v->value[i * v->bands + k] = 0.5 * (v->value[a * v->bands + k] + v->value[b * v->bands + k]);
}

static int by_leaf(const void *a, const void *b)
{
    const struct passing *p = a, *q = b;
    return p->leaf != q->leaf ? p->leaf < q->leaf ? -1 : 1 : p->vertex < q->vertex ? -1 : p->vertex > q->vertex;
}

/* Returns 0 or -1. */
static int average(struct vertex_values *v, const struct solution *solution, double *weight)
{
    const struct hierarchy *h = solution->hierarchy;
    for (uint32_t i = 0; i < h->count; i++) {
        const struct element *e = &h->elements[i];
        for (uint32_t j = 0; is_leaf(e) && j < e->vertices; j++) {
            uint32_t c = find_or_add(v, h, e, e->vertex[j]);
            if (c == NO_VERTEX)
                return -1;
            v->corner[4 * (size_t)i + j] = c;
            weight[c] += e->area;
            for (uint32_t k = 0; k < v->bands; k++)
                v->value[(size_t)c * v->bands + k] += e->area * solution->radiosity[(size_t)i * v->bands + k];
        }
    }
    uint32_t kept = 0;
    for (uint32_t i = 0; i < v->passing_count; i++) {
        uint32_t leaf = v->passing[i].leaf;
        const struct element *e = &h->elements[leaf];
        const struct shared_vertex *s = &v->vertices[v->passing[i].vertex];
        double inward[3];
        sub3(inward, e->centre, s->position);
        uint32_t c = find(v, s->position, s->normal, s->material, inward);
        if (c == NO_VERTEX) /* nobody on this side of a wall has it */
            continue;
        v->passing[kept++] = (struct passing){ leaf, c };
        weight[c] += e->area;
        for (uint32_t k = 0; k < v->bands; k++)
            v->value[(size_t)c * v->bands + k] += e->area * solution->radiosity[(size_t)leaf * v->bands + k];
    }
    v->passing_count = kept;
    if (kept)
        qsort(v->passing, kept, sizeof *v->passing, by_leaf);
    for (uint32_t c = 0; c < v->count; c++)
        for (uint32_t k = 0; k < v->bands && weight[c] > 0; k++)
            v->value[(size_t)c * v->bands + k] /= weight[c];
    return 0;
}

int vertex_values_build(struct vertex_values *v, const struct solution *solution)
{
    const struct hierarchy *h = solution->hierarchy;
    size_t corners = 0;
    *v = (struct vertex_values){.bands = solution->bands, .table_size = 16};
    for (uint32_t i = 0; i < h->count; i++)
        corners += is_leaf(&h->elements[i]) ? h->elements[i].vertices : 0;
    if (corners >= NO_VERTEX / 4)
        return -1;
    while (v->table_size < corners)
        v->table_size *= 2;
    double *weight = calloc(corners + 1, sizeof *weight);
    v->vertices = malloc((corners + 1) * sizeof *v->vertices);
    v->value = calloc((corners + 1) * v->bands, sizeof *v->value);
    v->corner = malloc(4 * (size_t)h->count * sizeof *v->corner);
    v->table = malloc(v->table_size * sizeof *v->table);
    v->contact = malloc(CONTACT_DIRECTIONS * sizeof *v->contact);
    v->contact_capacity = CONTACT_DIRECTIONS;
    if (!weight || !v->contact || !v->vertices || !v->value || !v->corner || !v->table) {
        free(weight);
        vertex_values_free(v);
        return -1;
    }
    memset(v->table, 0xff, v->table_size * sizeof *v->table);
    memset(v->corner, 0xff, 4 * (size_t)h->count * sizeof *v->corner);
    int failed = average(v, solution, weight);
    free(weight);
    if (failed) {
        vertex_values_free(v);
        return -1;
    }
    for (uint32_t i = 0; i < h->count; i++) {
        const struct element *e = &h->elements[i];
        const uint32_t *c = &v->corner[4 * (size_t)i];
        for (uint32_t j = 0; is_leaf(e) && j < e->vertices; j++)
            mark_hanging(v, c[j], c[j + 1 < e->vertices ? j + 1 : 0]);
    }
    for (uint32_t i = 0; i < v->count; i++)
        settle(v, i);
    return 0;
}

void vertex_values_free(struct vertex_values *v)
{
    free(v->vertices);
    free(v->value);
    free(v->corner);
    free(v->table);
    free(v->contact);
    free(v->passing);
    *v = (struct vertex_values){0};
}

uint32_t vertex_values_at(const struct vertex_values *v, const struct hierarchy *h, uint32_t face,
                          const double point[3], double *radiosity)
{
    double weight[4];
    uint32_t leaf = descend(h, face, point, weight), n = h->elements[leaf].vertices;
    for (uint32_t k = 0; k < v->bands; k++) {
        radiosity[k] = 0;
        for (uint32_t j = 0; j < n; j++)
            radiosity[k] += weight[j] * v->value[(size_t)v->corner[4 * (size_t)leaf + j] * v->bands + k];
    }
    return leaf;
}
