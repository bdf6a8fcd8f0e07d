/* group_hierarchy.c - a hierarchy with flat groups of faces between clusters and faces.
 *
 * A matrix needs every pair of faces, so what a hierarchy can save is not links but questions:
 * whether anything stands between, how near, who turns to whom. These have one answer for all pairs
 * of two walls' patches. Clusters by the surface-area heuristic mix a wall with the strip of floor
 * beside it, and nothing is true of such a group. So here faces are first gathered by plane
 * (coplanar_groups.h); each plane's faces make a tree of groups with an outline each
 * (group_outline.h), which is a surface that shafts, distances and planes can be asked about; above
 * the planes stand clusters.
 *
 * What blocks light is as few as possible: the largest groups whose faces tile their outline stand
 * in shafts as one face each. So what a polygon was cut into is not taken apart before what is
 * beside it.
 *
 * Invariant: a group's faces lie in its plane, to h.flat, and within its outline, to rounding; the
 * tree depends on the faces alone.
 * [derived here]
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "hierarchy/coplanar_groups.h"
#include "hierarchy/group_hierarchy.h"
#include "hierarchy/group_outline.h"
#include "kernel/constants.h"
#include "kernel/hash.h"

enum { FANOUT = 4 };

struct builder {
    struct hierarchy *h;
    const struct hierarchy *plain; /* measured face elements, and the scene's box */
    double size;                   /* m */
    struct coplanar_groups planes;
    /* [face_count]: by face, the middle of its rectangle in its plane's frame, and of its
     * polygon's; the first face of that, where its rectangle in the plane at hand is */
    double (*at)[2], (*polygon_at)[2];
    uint32_t *first;
    struct rectangle {
        double low[2], high[2];
    } * box;
    double (*centre)[3]; /* [planes]: the middle of the plane's box */
    struct outliner outliner;
    struct face_share *shares; /* [face_count]: by place in the tree's order */
};

static void find_centres(struct builder *b)
{
    for (uint32_t i = 0; i < b->planes.count; i++) {
        double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
        for (uint32_t j = b->planes.groups[i].from; j < b->planes.groups[i].to; j++) {
            const struct element *e = hierarchy_surface(b->plain, b->planes.order[j]);
            for (int c = 0; c < e->vertices; c++)
                for (int k = 0; k < 3; k++) {
                    low[k] = e->vertex[c][k] < low[k] ? e->vertex[c][k] : low[k];
                    high[k] = e->vertex[c][k] > high[k] ? e->vertex[c][k] : high[k];
                }
        }
        for (int k = 0; k < 3; k++)
            b->centre[i][k] = 0.5 * (low[k] + high[k]);
    }
}

/* ---- elements */

static uint32_t add_children(struct builder *b, uint32_t parent, int count)
{
    struct hierarchy *h = b->h;
    uint32_t first = h->count;
    h->elements[parent].child = first;
    h->elements[parent].children = (uint8_t)count;
    h->count += (uint32_t)count;
    for (uint32_t i = first; i < h->count; i++) {
        memset(&h->elements[i], 0, sizeof *h->elements);
        h->elements[i].parent = parent;
        h->elements[i].id = hash64(i + HASH_STEP);
        element_reset(&h->elements[i]);
        h->elements[i].radiosity = 1;
    }
    return first;
}

static void make_face(struct builder *b, uint32_t index, uint32_t at)
{
    struct hierarchy *h = b->h;
    struct element *e = &h->elements[index];
    uint32_t parent = e->parent, face = h->order[at];
    *e = *hierarchy_surface(b->plain, face);
    e->parent = parent;
    e->radiosity = 1;
    e->reflectance = 0;
    e->black = 0;
    h->face_element[face] = index;
    h->range[index] = (struct face_range){at, at + 1};
    b->h->solid[index] = 1;
}

/* Are all in the range parts of one? */
static int is_whole(const uint32_t *whole, const uint32_t *list, struct face_range range)
{
    uint32_t i = range.from;
    while (whole && i < range.to && whole[list[i]] == whole[list[range.from]])
        i++;
    return whole && i == range.to;
}

/* Element `index` becomes the group's surface. */
static void make_outline(struct builder *b, uint32_t index, const struct group_frame *f,
                         struct face_range range, int within_solid)
{
    struct element *e = &b->h->elements[index];
    const struct group_faces faces = {b->h->order + range.from, range.to - range.from};
    group_outline(&b->outliner, f, faces, e);
    e->cone = 1;
    e->face = *faces.face;
    e->group = 1;
    b->h->range[index] = range;
    b->h->solid[index] = (unsigned char)(!within_solid
                                         && (is_whole(b->first, b->h->order, range)
                                                 ? group_fills(f, e)
                                                 : group_tiles(&b->outliner, f, faces, e)));
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

/* The place nearest to the middle of a sorted list where neighbours differ; the middle when none
 * do. */
static uint32_t middle(const struct along *list, uint32_t count, double near)
{
    uint32_t half = count / 2;
    for (uint32_t step = 0; step < half; step++) {
        if (list[half + step < count ? half + step : count - 1].at - list[half + step - 1].at
            > near)
            return half + step;
        if (half > step + 1 && list[half - step].at - list[half - step - 1].at > near)
            return half - step;
    }
    return half;
}

/* Places by which a list is ordered: of item i, centre[stride * i + axis]. */
struct places {
    const double *centre;
    size_t stride;
    int axes;
    const uint32_t *whole; /* of items that stay together as long as others are there; or NULL */
};

/* The axis along which the n items lie farthest apart; the first of those that are alike. */
static int longest_axis(const struct places *p, const uint32_t *items, uint32_t n)
{
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t i = 0; i < n; i++)
        for (int k = 0; k < p->axes; k++) {
            double x = p->centre[p->stride * items[i] + (size_t)k];
            low[k] = x < low[k] ? x : low[k];
            high[k] = x > high[k] ? x : high[k];
        }
    int axis = 0;
    for (int k = 1; k < p->axes; k++)
        if (high[k] - low[k] > (high[axis] - low[axis]) * (1 + 1e-6))
            axis = k;
    return axis;
}

/* Sort n items along their longest axis. Returns where the second half begins. */
static uint32_t halve(const struct builder *b, const struct places *p, uint32_t *items, uint32_t n,
                      struct along *scratch)
{
    int axis = longest_axis(p, items, n);
    for (uint32_t i = 0; i < n; i++)
        scratch[i] = (struct along){p->centre[p->stride * items[i] + (size_t)axis], items[i]};
    qsort(scratch, n, sizeof *scratch, compare_along);
    for (uint32_t i = 0; i < n; i++)
        items[i] = scratch[i].what;
    return middle(scratch, n, GROUP_SAME_PLACE * b->size);
}

/* Parts of a range of the list, the widest halved until there are FANOUT, or none is wider than
 * `least`, or is whole. Returns how many. */
static int divide_range(const struct builder *b, const struct places *p, uint32_t *list,
                        struct face_range range, struct along *scratch,
                        struct face_range part[FANOUT], uint32_t least)
{
    int parts = 1;
    part[0] = range;
    while (parts < FANOUT) {
        int widest = 0;
        uint32_t n = 0;
        for (int k = 0; k < parts; k++)
            if (part[k].to - part[k].from > n
                && (parts == 1 || !is_whole(p->whole, list, part[k]))) {
                widest = k;
                n = part[k].to - part[k].from;
            }
        if (n < 2 || (n <= least && parts > 1))
            break;
        uint32_t cut = halve(b, p, list + part[widest].from, n, scratch);
        memmove(&part[widest + 1], &part[widest], (size_t)(parts - widest) * sizeof *part);
        part[widest].to = part[widest + 1].from = part[widest].from + cut;
        parts++;
    }
    return parts;
}

static int each_face(struct face_range range, struct face_range part[LOWEST_GROUP])
{
    int parts = 0;
    for (uint32_t i = range.from; i < range.to; i++)
        part[parts++] = (struct face_range){i, i + 1};
    return parts;
}

/* The faces of each polygon in the range, which is put in that order. */
static int each_polygon(const struct builder *b, struct face_range range,
                        struct face_range part[LOWEST_GROUP])
{
    uint32_t *order = b->h->order;
    int parts = 0;
    for (uint32_t i = range.from; i < range.to; i++) {
        const uint32_t face = order[i];
        int k = 0;
        while (k < parts && b->first[order[part[k].from]] != b->first[face])
            k++;
        if (k == parts) {
            part[parts++] = (struct face_range){i, i + 1};
            continue;
        }
        memmove(&order[part[k].to + 1], &order[part[k].to], (i - part[k].to) * sizeof *order);
        order[part[k].to++] = face;
        for (k++; k < parts; k++) {
            part[k].from++;
            part[k].to++;
        }
    }
    return parts;
}

/* Element `index` becomes the group of the faces in the range, or the one face. */
static void make_group(struct builder *b, struct along *scratch, uint32_t index,
                       const struct group_frame *f, struct face_range range, int within_solid)
{
    uint32_t n = range.to - range.from;
    if (n == 1) {
        make_face(b, index, range.from);
        return;
    }
    make_outline(b, index, f, range, within_solid);
    within_solid |= b->h->solid[index];
    uint32_t first;
    const int whole = is_whole(b->first, b->h->order, range);
    if (n <= LOWEST_GROUP) {
        struct face_range part[LOWEST_GROUP];
        const int parts = whole ? each_face(range, part) : each_polygon(b, range, part);
        first = add_children(b, index, parts);
        for (int k = 0; k < parts; k++)
            make_group(b, scratch, first + (uint32_t)k, f, part[k], within_solid);
        return;
    }
    struct face_range part[FANOUT];
    const struct places in_plane = {whole ? b->at[0] : b->polygon_at[0], 2, 2,
                                    whole ? NULL : b->first};
    int parts = divide_range(b, &in_plane, b->h->order, range, scratch, part, LOWEST_GROUP);
    first = add_children(b, index, parts);
    for (int k = 0; k < parts; k++)
        make_group(b, scratch, first + (uint32_t)k, f, part[k], within_solid);
}

/* The cluster of the faces in its range. */
static void make_cluster_element(struct builder *b, uint32_t index)
{
    struct face_range range = b->h->range[index];
    struct bounds box;
    bounds_empty(&box);
    for (uint32_t i = range.from; i < range.to; i++) {
        const struct element *s = hierarchy_surface(b->plain, b->h->order[i]);
        struct bounds own;
        bounds_empty(&own);
        for (int c = 0; c < s->vertices; c++)
            for (int k = 0; k < 3; k++) {
                own.low[k] = s->vertex[c][k] < own.low[k] ? s->vertex[c][k] : own.low[k];
                own.high[k] = s->vertex[c][k] > own.high[k] ? s->vertex[c][k] : own.high[k];
            }
        bounds_add(&box, &own);
        b->shares[i] = (struct face_share){{s->normal[0], s->normal[1], s->normal[2]}, s->area, 0};
    }
    element_measure_cluster(&b->h->elements[index], b->shares, &box, range);
}

/* Where the faces of a plane are in it, and what of their polygons is in it. */
static void find_places(struct builder *b, const struct group_frame *f, struct face_range range)
{
    for (uint32_t i = range.from; i < range.to; i++)
        b->box[b->first[b->h->order[i]]] =
            (struct rectangle){{INFINITY, INFINITY}, {-INFINITY, -INFINITY}};
    for (uint32_t i = range.from; i < range.to; i++) {
        const uint32_t face = b->h->order[i];
        double low[2], high[2];
        group_bounds(&b->outliner, f, (struct group_faces){&face, 1}, low, high);
        struct rectangle *box = &b->box[b->first[face]];
        for (int k = 0; k < 2; k++) {
            b->at[face][k] = 0.5 * (low[k] + high[k]);
            box->low[k] = low[k] < box->low[k] ? low[k] : box->low[k];
            box->high[k] = high[k] > box->high[k] ? high[k] : box->high[k];
        }
    }
    for (uint32_t i = range.from; i < range.to; i++) {
        const uint32_t face = b->h->order[i];
        const struct rectangle *box = &b->box[b->first[face]];
        for (int k = 0; k < 2; k++)
            b->polygon_at[face][k] = 0.5 * (box->low[k] + box->high[k]);
    }
}

/* Of each face the first one of its polygon: parts are neighbours in the list. */
static void find_polygons(struct builder *b)
{
    const struct face *faces = b->plain->faces;
    for (uint32_t i = 0; i < b->plain->face_count; i++)
        b->first[i] = i > 0 && faces[i].input == faces[i - 1].input ? b->first[i - 1] : i;
}

/* Element `index` becomes the cluster of the planes list[range], or the one plane's group. Orders
 * the faces as it goes: `at` is where the first one's stand. */
static void make_cluster(struct builder *b, struct along *scratch, uint32_t *list, uint32_t *order,
                         uint32_t index, struct face_range range, uint32_t at)
{
    if (range.to - range.from == 1 && index != 0) {
        const struct face_range *plane = &b->planes.groups[list[range.from]];
        struct face_range faces = {at, at + plane->to - plane->from};
        memcpy(b->h->order + at, order + plane->from, (plane->to - plane->from) * sizeof *order);
        struct group_frame f;
        if (faces.to - faces.from > 1) {
            group_frame_of(&b->outliner,
                           (struct group_faces){b->h->order + at, faces.to - faces.from}, &f);
            find_places(b, &f, faces);
        }
        make_group(b, scratch, index, &f, faces, 0);
        return;
    }
    struct face_range part[FANOUT];
    const struct places in_space = {b->centre[0], 3, 3, NULL};
    int parts =
        range.to - range.from > 1 ? divide_range(b, &in_space, list, range, scratch, part, 1) : 1;
    if (parts == 1)
        part[0] = range;
    uint32_t first = add_children(b, index, parts);
    b->h->range[index].from = at;
    for (int k = 0; k < parts; k++) {
        make_cluster(b, scratch, list, order, first + (uint32_t)k, part[k], at);
        at = b->h->range[first + (uint32_t)k].to;
    }
    b->h->range[index].to = at;
    make_cluster_element(b, index);
}

int hierarchy_build_groups(struct hierarchy *h, const struct hierarchy *plain, double flat)
{
    uint32_t n = plain->face_count, most = 2 * n + 2, *list = malloc(n * sizeof *list);
    struct along *scratch = malloc(n * sizeof *scratch);
    struct builder b = {.h = h, .plain = plain};
    int result = -1;
    memset(h, 0, sizeof *h);
    h->faces = plain->faces;
    h->face_count = n;
    h->flat = flat;
    b.at = calloc(n, sizeof *b.at);
    b.polygon_at = calloc(n, sizeof *b.polygon_at);
    b.first = malloc(n * sizeof *b.first);
    b.box = malloc(n * sizeof *b.box);
    b.centre = malloc(n * sizeof *b.centre);
    b.shares = malloc(n * sizeof *b.shares);
    h->elements = malloc(most * sizeof *h->elements);
    h->capacity = most;
    h->face_element = malloc(n * sizeof *h->face_element);
    h->order = malloc(n * sizeof *h->order);
    h->range = malloc(most * sizeof *h->range);
    h->solid = calloc(most, 1);
    if (!list || !scratch || !b.at || !b.polygon_at || !b.first || !b.box || !b.centre || !b.shares
        || !h->elements || !h->face_element || !h->order || !h->range || !h->solid
        || outliner_open(&b.outliner, plain, flat) < 0
        || coplanar_groups_find(&b.planes, plain, flat) < 0)
        goto done;
    for (int k = 0; k < 3; k++) {
        double side = plain->high[k] - plain->low[k];
        h->low[k] = plain->low[k];
        h->high[k] = plain->high[k];
        b.size = side > b.size ? side : b.size;
    }
    find_centres(&b);
    find_polygons(&b);
    for (uint32_t i = 0; i < b.planes.count; i++)
        list[i] = i;
    h->count = 1;
    memset(h->elements, 0, sizeof *h->elements);
    h->elements[0].id = hash64(HASH_STEP);
    element_reset(&h->elements[0]);
    h->elements[0].radiosity = 1;
    make_cluster(&b, scratch, list, b.planes.order, 0, (struct face_range){0, b.planes.count}, 0);
    h->built = h->count;
    result = 0;
done:
    free(list);
    free(scratch);
    free(b.at);
    free(b.polygon_at);
    free(b.first);
    free(b.box);
    free(b.centre);
    outliner_close(&b.outliner);
    free(b.shares);
    coplanar_groups_free(&b.planes);
    if (result < 0)
        hierarchy_free(h);
    return result;
}
