/* coplanar_groups.c - which faces lie in one plane.
 *
 * Faces are sorted by one coordinate of their normals after the other, then by the height of their
 * planes, and parted wherever neighbours in that order stand apart. What is left together is a
 * group when it lies in one plane, that of the sum of its faces; when it does not, as where a
 * slowly bent wall has no gap anywhere, its faces stay alone. [derived here]
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "hierarchy/coplanar_groups.h"
#include "kernel/constants.h"

struct placed_face {
    double key[4]; /* normal, height of the plane (m) */
    uint32_t face;
};

struct finder {
    const struct hierarchy *plain;
    double flat;               /* m */
    struct placed_face *items; /* [faces] */
};

static int compare_key(const struct placed_face *a, const struct placed_face *b, int k)
{
    return a->key[k] < b->key[k]   ? -1
           : a->key[k] > b->key[k] ? 1
           : a->face < b->face     ? -1
                                   : a->face > b->face;
}

static int by_x(const void *a, const void *b)
{
    return compare_key(a, b, 0);
}
static int by_y(const void *a, const void *b)
{
    return compare_key(a, b, 1);
}
static int by_z(const void *a, const void *b)
{
    return compare_key(a, b, 2);
}
static int by_height(const void *a, const void *b)
{
    return compare_key(a, b, 3);
}

static int by_face(const void *a, const void *b)
{
    const struct placed_face *x = a, *y = b;
    return x->face < y->face ? -1 : x->face > y->face;
}

/* Do the faces lie in one plane? In that of them all: rounded corners turn a small face's. */
static int one_plane(const struct finder *b, const struct placed_face *items, uint32_t count)
{
    double n[3] = {0, 0, 0}, at[3] = {0, 0, 0}, area = 0;
    const struct element *first = hierarchy_surface(b->plain, items[0].face);
    for (uint32_t i = 0; i < count; i++) {
        const struct element *e = hierarchy_surface(b->plain, items[i].face);
        area += e->area;
        for (int k = 0; k < 3; k++) {
            n[k] += e->area * e->normal[k];
            at[k] += e->area * (e->centre[k] - first->centre[k]);
        }
    }
    double size = length3(n);
    for (int k = 0; k < 3; k++) {
        n[k] /= size;
        at[k] = first->centre[k] + at[k] / area;
    }
    for (uint32_t i = 0; i < count; i++) {
        const struct element *e = hierarchy_surface(b->plain, items[i].face);
        if (!(dot3(e->normal, n) > GROUP_COSINE)
            || b->plain->faces[e->face].back != b->plain->faces[first->face].back)
            return 0;
        for (int k = 0; k < e->vertices; k++)
            if (!(fabs(height3(e->vertex[k], at, n)) <= b->flat))
                return 0;
    }
    return 1;
}

/* Part a run of items where key k leaves a gap, each part by the next key, until they are planes; a
 * run that is none is left as single faces. Heights are parted by a wide gap, and what is no plane
 * by a narrow one. Writes where each plane begins. */
static void part_by_key(struct finder *b, uint32_t from, uint32_t to, int k, unsigned char *begins)
{
    static int (*const order[])(const void *, const void *) = {by_x, by_y, by_z, by_height,
                                                               by_height};
    const double gap[] = {GROUP_NORMAL_GAP, GROUP_NORMAL_GAP, GROUP_NORMAL_GAP,
                          GROUP_WIDE_GAP * b->flat, GROUP_HEIGHT_GAP * b->flat};
    int flat = k >= 4 && one_plane(b, b->items + from, to - from);
    uint32_t i;
    if (flat || k == 5) {
        qsort(b->items + from, to - from, sizeof *b->items, by_face);
        begins[from] = 1;
        for (i = from + 1; i < to; i++)
            begins[i] = !flat;
        return;
    }
    qsort(b->items + from, to - from, sizeof *b->items, order[k]);
    uint32_t start;
    for (start = from, i = from + 1; i <= to; i++)
        if (i == to
            || b->items[i].key[k < 4 ? k : 3] - b->items[i - 1].key[k < 4 ? k : 3] > gap[k]) {
            part_by_key(b, start, i, k + 1, begins);
            start = i;
        }
}

static int place_faces(struct finder *b)
{
    const struct hierarchy *h = b->plain;
    double size = 0;
    b->items = malloc(h->face_count * sizeof *b->items);
    if (!b->items)
        return -1;
    for (int k = 0; k < 3; k++)
        size = fmax(size, h->high[k] - h->low[k]);
    for (uint32_t i = 0; i < h->face_count; i++) {
        const struct element *e = hierarchy_surface(b->plain, i);
        struct placed_face *x = &b->items[i];
        x->face = i;
        for (int k = 0; k < 3; k++)
            x->key[k] = e->normal[k];
        x->key[3] = 0;
        /* about the scene's middle, where rounding is least; far sides apart from fronts */
        for (int k = 0; k < 3; k++)
            x->key[3] += e->normal[k] * (e->centre[k] - 0.5 * (h->low[k] + h->high[k]));
        x->key[3] += h->faces[i].back * 4 * size;
    }
    return 0;
}

int coplanar_groups_find(struct coplanar_groups *g, const struct hierarchy *plain, double flat)
{
    struct finder b = {.plain = plain, .flat = flat};
    uint32_t n = plain->face_count;
    unsigned char *begins = calloc(n, 1);
    *g = (struct coplanar_groups){.order = malloc(n * sizeof *g->order),
                                  .groups = malloc(n * sizeof *g->groups)};
    if (!begins || !g->order || !g->groups || place_faces(&b) < 0) {
        free(begins);
        coplanar_groups_free(g);
        return -1;
    }
    part_by_key(&b, 0, n, 0, begins);
    for (uint32_t i = 0; i < n; i++) {
        g->order[i] = b.items[i].face;
        if (begins[i])
            g->groups[g->count++].from = i;
        g->groups[g->count - 1].to = i + 1;
    }
    free(begins);
    free(b.items);
    return 0;
}

void coplanar_groups_free(struct coplanar_groups *g)
{
    free(g->order);
    free(g->groups);
    *g = (struct coplanar_groups){0};
}
