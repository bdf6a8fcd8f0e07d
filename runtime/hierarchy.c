/* hierarchy.c - build the clusters above the faces, split surfaces below them.
 *
 * Clusters come from a top-down binned surface-area heuristic [Wald 2007], two levels of it folded
 * into one, so that an inner node has up to four children as a split surface has. They are made
 * breadth first; every child block is contiguous. Invariant: indices depend on the order of
 * splits, identities (`id`) only on the path from the root.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "hierarchy.h"

enum { BINS = 16, FANOUT = 4 };

/* What stands for a parent in the identities of faces, wherever the clusters put them. */
#define FACES 0x2545f4914f6cdd1du

struct builder {
    struct hierarchy *h;
    uint32_t *order, *scratch; /* [face_count] */
    double (*centre)[3];       /* [face_count]: middle of the face's box */
};

static uint64_t child_id(uint64_t parent, uint32_t k)
{
    uint64_t x = parent * 4 + k + 0x9e3779b97f4a7c15u;
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
    x = (x ^ x >> 27) * 0x94d049bb133111ebu;
    return x ^ x >> 31;
}

static void box_empty(double low[3], double high[3])
{
    int k;
    for (k = 0; k < 3; k++) {
        low[k] = INFINITY;
        high[k] = -INFINITY;
    }
}

static void box_add(double low[3], double high[3], const double p[3])
{
    int k;
    for (k = 0; k < 3; k++) {
        low[k] = p[k] < low[k] ? p[k] : low[k];
        high[k] = p[k] > high[k] ? p[k] : high[k];
    }
}

static void box_add_face(double low[3], double high[3], const struct face *f)
{
    uint32_t i;
    for (i = 0; i < f->vertices; i++)
        box_add(low, high, f->vertex[i]);
}

static double box_area(const double low[3], const double high[3])
{
    double x = high[0] - low[0], y = high[1] - low[1], z = high[2] - low[2];
    return x < 0 ? 0 : x * y + y * z + z * x;
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

/* What a solver may say of an element later. */
static void reset_fields(struct element *e)
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
    reset_fields(e);
}

/* Box, cone of normals, area of the faces in a range. Exactly equal normals give a cone of angle 0. */
static void measure_cluster(const struct builder *b, struct element *e, struct face_range range)
{
    double low[3], high[3], axis[3] = { 0, 0, 0 }, size;
    uint32_t i;
    int k;
    box_empty(low, high);
    reset_fields(e);
    e->black = 1;
    for (i = range.from; i < range.to; i++) {
        const struct face *f = &b->h->faces[b->order[i]];
        struct element s = { 0 };
        box_add_face(low, high, f);
        memcpy(s.vertex, f->vertex, sizeof s.vertex);
        s.vertices = (uint8_t)f->vertices;
        measure_surface(&s);
        e->area += s.area;
        e->black &= f->black;
        for (k = 0; k < 3; k++)
            axis[k] += s.area * s.normal[k];
    }
    size = length3(axis);
    e->cone = size > 1e-9 * e->area ? 1 : -1;
    for (k = 0; k < 3; k++)
        e->normal[k] = size > 0 ? axis[k] / size : 0;
    for (i = range.from; i < range.to && e->cone > 0; i++) {
        const struct face *f = &b->h->faces[b->order[i]];
        struct element s = { 0 };
        double c;
        memcpy(s.vertex, f->vertex, sizeof s.vertex);
        s.vertices = (uint8_t)f->vertices;
        measure_surface(&s);
        c = dot3(s.normal, e->normal);
        if (c < 1 - 1e-14 && c < e->cone)
            e->cone = c;
    }
    for (k = 0; k < 3; k++) {
        e->centre[k] = 0.5 * (low[k] + high[k]);
        e->vertex[0][k] = low[k];
        e->vertex[1][k] = high[k];
    }
    sub3(axis, high, low);
    e->radius = 0.5 * length3(axis);
}

/* Cut a range in two, stably. The place is the cheapest of BINS - 1 planes on each axis, or the
 * middle of the order when all centres coincide. */
static uint32_t cut(const struct builder *b, struct face_range range)
{
    double low[3], high[3], best = INFINITY, best_at = 0;
    uint32_t i, left, right, count = range.to - range.from;
    int k, best_axis = -1;
    box_empty(low, high);
    for (i = range.from; i < range.to; i++)
        box_add(low, high, b->centre[b->order[i]]);
    for (k = 0; k < 3; k++) {
        double bin_low[BINS][3], bin_high[BINS][3], from_right[BINS], l[3], g[3], size = high[k] - low[k];
        uint32_t bin_count[BINS] = { 0 }, n;
        int j;
        if (!(size > 0))
            continue;
        for (j = 0; j < BINS; j++)
            box_empty(bin_low[j], bin_high[j]);
        for (i = range.from; i < range.to; i++) {
            uint32_t f = b->order[i];
            int bin = (int)((b->centre[f][k] - low[k]) / size * BINS);
            bin = bin >= BINS ? BINS - 1 : bin;
            bin_count[bin]++;
            box_add_face(bin_low[bin], bin_high[bin], &b->h->faces[f]);
        }
        box_empty(l, g);
        for (n = 0, j = BINS - 1; j > 0; j--) {
            n += bin_count[j];
            box_add(l, g, bin_low[j]);
            box_add(l, g, bin_high[j]);
            from_right[j] = box_area(l, g) * n;
        }
        box_empty(l, g);
        for (n = 0, j = 0; j < BINS - 1; j++) {
            double cost;
            n += bin_count[j];
            box_add(l, g, bin_low[j]);
            box_add(l, g, bin_high[j]);
            cost = box_area(l, g) * n + from_right[j + 1];
            if (n > 0 && n < count && cost < best) {
                best = cost;
                best_axis = k;
                best_at = (j + 1) / (double)BINS;
            }
        }
    }
    if (best_axis < 0)
        return range.from + count / 2;
    for (left = right = 0, i = range.from; i < range.to; i++) {
        uint32_t f = b->order[i];
        double size = high[best_axis] - low[best_axis];
        int bin = (int)((b->centre[f][best_axis] - low[best_axis]) / size * BINS);
        if (bin < (int)(best_at * BINS + 0.5))
            b->order[range.from + left++] = f;
        else
            b->scratch[right++] = f;
    }
    memcpy(&b->order[range.from + left], b->scratch, right * sizeof *b->scratch);
    return range.from + left;
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

/* Give element `parent`, which covers `range`, its children. pending[i] is the range of element i. */
static void open_cluster(const struct builder *b, uint32_t parent, struct face_range *pending)
{
    struct hierarchy *h = b->h;
    struct face_range part[FANOUT];
    int parts = 1, k;
    part[0] = pending[parent];
    while (parts < FANOUT) {
        int widest = 0;
        uint32_t middle;
        for (k = 1; k < parts; k++)
            if (part[k].to - part[k].from > part[widest].to - part[widest].from)
                widest = k;
        if (part[widest].to - part[widest].from < 2)
            break;
        middle = cut(b, part[widest]);
        memmove(&part[widest + 1], &part[widest], (size_t)(parts - widest) * sizeof *part);
        part[widest].to = part[widest + 1].from = middle;
        parts++;
    }
    h->elements[parent].child = h->count;
    h->elements[parent].children = (uint8_t)parts;
    for (k = 0; k < parts; k++) {
        uint32_t index = h->count++;
        struct element *e = &h->elements[index];
        memset(e, 0, sizeof *e);
        e->parent = parent;
        pending[index] = part[k];
        if (part[k].to - part[k].from == 1) {
            make_face(h, index, b->order[part[k].from]);
        } else {
            e->id = child_id(h->elements[parent].id, (uint32_t)k);
            measure_cluster(b, e, part[k]);
        }
    }
}

int hierarchy_build(struct hierarchy *h, const struct face *faces, uint32_t face_count)
{
    struct builder b = { 0 };
    struct face_range *pending = NULL;
    uint32_t i, most = face_count < 2 ? 2 : 2 * face_count;
    int k, result = -1;
    memset(h, 0, sizeof *h);
    if (face_count == 0 || face_count > UINT32_MAX / 4)
        return -1;
    h->faces = faces;
    h->face_count = face_count;
    h->face_element = malloc(face_count * sizeof *h->face_element);
    b.h = h;
    b.order = malloc(face_count * sizeof *b.order);
    b.scratch = malloc(face_count * sizeof *b.scratch);
    b.centre = malloc(face_count * sizeof *b.centre);
    pending = malloc(most * sizeof *pending);
    if (!h->face_element || !b.order || !b.scratch || !b.centre || !pending || reserve(h, most) < 0)
        goto done;
    box_empty(h->low, h->high);
    for (i = 0; i < face_count; i++) {
        double low[3], high[3];
        box_empty(low, high);
        box_add_face(low, high, &faces[i]);
        box_add(h->low, h->high, low);
        box_add(h->low, h->high, high);
        for (k = 0; k < 3; k++)
            b.centre[i][k] = 0.5 * (low[k] + high[k]);
        b.order[i] = i;
    }
    h->count = 1;
    memset(&h->elements[0], 0, sizeof h->elements[0]);
    h->elements[0].id = child_id(0, 0);
    pending[0].from = 0;
    pending[0].to = face_count;
    measure_cluster(&b, &h->elements[0], pending[0]);
    for (i = 0; i < h->count; i++) /* breadth first: the list of elements is its own queue */
        if (!h->elements[i].vertices)
            open_cluster(&b, i, pending);
    h->built = h->count;
    h->order = b.order;
    h->range = pending;
    b.order = NULL;
    pending = NULL;
    result = 0;
done:
    free(pending);
    free(b.centre);
    free(b.scratch);
    free(b.order);
    if (result < 0)
        hierarchy_free(h);
    return result;
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
    memset(h, 0, sizeof *h);
}
