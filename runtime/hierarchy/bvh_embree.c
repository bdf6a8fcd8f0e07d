/* bvh_embree.c - clusters by Embree's builder in high quality: binned surface-area heuristic with
 * spatial splits [Stich, Friedrich and Dietrich 2009].
 *
 * A spatial split puts parts of one face on both sides. A face belongs to one cluster, so it stays
 * where the part nearest to its centre went, and nodes that lose all their faces go. Embree calls
 * back from many threads and joins in any order: children are sorted by the smallest face below
 * them, so that the tree is what was cut, and not who cut it first. Embree works in single
 * precision: boxes are moved and scaled to a size of about one by a power of two, as in rays.c.
 * Boxes of clusters are made anew from the faces.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "hierarchy/bvh_strategy.h"
#include "util/embree.h"
#include "util/embree_memory.h"
#include "hierarchy/hierarchy.h"
#include "util/thread_pool.h"

/* FANOUT: children of a node at the most. DEEPEST: Embree counts levels down to it and is done
 * long before. */
enum { FANOUT = 4, DEEPEST = 256 };
static const double SPLITS = 0.2; /* parts made by splits, of the faces */

/* Embree's node, in its memory. */
struct cut {
    uint32_t children; /* 0: a leaf */
    uint32_t face;     /* of a leaf; else the smallest that stays below, NOTHING when none does */
    struct cut *child[FANOUT];
    struct bounds box; /* of a leaf: of its part, in Embree's coordinates */
};

/* The same, packed: node `at` of a part. Its children are neighbours. */
struct packed {
    uint32_t to, child, children;
};

struct own {
    struct packed *nodes; /* [count] */
    uint32_t count;
};

#define NOTHING UINT32_MAX

struct builder {
    const struct build *b;
    double origin[3], scale;
    const struct cut **keeper; /* [count]: the leaf where a face stays */
    struct own *own;
    struct item *sorted; /* [count] */
    uint32_t placed;
    _Atomic int failed; /* out of memory */
};

static struct cut *create(RTCThreadLocalAllocator allocator, void *context)
{
    struct builder *a = context;
    struct cut *c = rtcThreadLocalAlloc(allocator, sizeof *c, 16);
    if (c)
        memset(c, 0, sizeof *c);
    else
        a->failed = 1;
    return c;
}

static void *create_node(RTCThreadLocalAllocator allocator, unsigned children, void *context)
{
    struct cut *c = create(allocator, context);
    if (c)
        c->children = children;
    return c;
}

static void set_children(void *node, void **children, unsigned count, void *context)
{
    struct cut *c = node;
    (void)context;
    for (unsigned i = 0; c && i < count; i++)
        c->child[i] = children[i];
}

static void set_bounds(void *node, const struct RTCBounds **bounds, unsigned count, void *context)
{
    (void)node, (void)bounds, (void)count, (void)context;
}

static void *create_leaf(RTCThreadLocalAllocator allocator, const struct RTCBuildPrimitive *p,
                         size_t count, void *context)
{
    struct cut *c = create(allocator, context);
    (void)count; /* 1, as asked for */
    if (!c)
        return NULL;
    c->face = p->primID;
    c->box = (struct bounds){{(double)p->lower_x, (double)p->lower_y, (double)p->lower_z},
                             {(double)p->upper_x, (double)p->upper_y, (double)p->upper_z}};
    return c;
}

static void set(struct RTCBounds *to, const struct bounds *from)
{
    to->lower_x = (float)from->low[0];
    to->lower_y = (float)from->low[1];
    to->lower_z = (float)from->low[2];
    to->upper_x = (float)from->high[0];
    to->upper_y = (float)from->high[1];
    to->upper_z = (float)from->high[2];
}

/* The boxes of what a face has on both sides of a plane, within the box of the part that is
 * split. */
static void split(const struct RTCBuildPrimitive *p, unsigned axis, float position,
                  struct RTCBounds *left, struct RTCBounds *right, void *context)
{
    const struct builder *a = context;
    const struct face *f = &a->b->faces[p->primID];
    const double low[3] = {(double)p->lower_x, (double)p->lower_y, (double)p->lower_z};
    const double high[3] = {(double)p->upper_x, (double)p->upper_y, (double)p->upper_z};
    struct bounds side[2], point;
    double at = (double)position, v[4][3];
    bounds_empty(&side[0]);
    bounds_empty(&side[1]);
    for (uint32_t i = 0; i < f->vertices; i++)
        for (int k = 0; k < 3; k++)
            v[i][k] = (f->vertex[i][k] - a->origin[k]) * a->scale;
    for (uint32_t i = 0; i < f->vertices; i++) {
        uint32_t j = i + 1 < f->vertices ? i + 1 : 0;
        double here = v[i][axis] - at;
        double there = v[j][axis] - at;
        memcpy(point.low, v[i], sizeof point.low);
        memcpy(point.high, v[i], sizeof point.high);
        if (here <= 0)
            bounds_add(&side[0], &point);
        if (here >= 0)
            bounds_add(&side[1], &point);
        if ((here < 0 && there > 0) || (here > 0 && there < 0)) {
            for (int k = 0; k < 3; k++)
                point.low[k] = point.high[k] =
                    v[i][k] + here / (here - there) * (v[j][k] - v[i][k]);
            point.low[axis] = point.high[axis] = at;
            bounds_add(&side[0], &point);
            bounds_add(&side[1], &point);
        }
    }
    for (int s = 0; s < 2; s++)
        for (int k = 0; k < 3; k++) {
            side[s].low[k] = side[s].low[k] > low[k] ? side[s].low[k] : low[k];
            side[s].high[k] = side[s].high[k] < high[k] ? side[s].high[k] : high[k];
        }
    set(left, &side[0]);
    set(right, &side[1]);
}

struct primitives {
    const struct builder *builder;
    struct RTCBuildPrimitive *list;
};

static void make_primitives(const void *primitives, size_t from, size_t to)
{
    const struct builder *a = ((const struct primitives *)primitives)->builder;
    struct RTCBuildPrimitive *list = ((const struct primitives *)primitives)->list;
    for (uint32_t i = (uint32_t)from; i < to; i++) {
        const struct item *x = &a->b->items[i];
        struct bounds box;
        for (int k = 0; k < 3; k++) {
            box.low[k] = (x->box.low[k] - a->origin[k]) * a->scale;
            box.high[k] = (x->box.high[k] - a->origin[k]) * a->scale;
        }
        struct RTCBounds r;
        set(&r, &box);
        list[i] = (struct RTCBuildPrimitive){r.lower_x, r.lower_y, r.lower_z, 0,
                                             r.upper_x, r.upper_y, r.upper_z, i};
    }
}

static struct RTCBuildPrimitive *primitives(const struct builder *a, size_t room)
{
    const struct build *b = a->b;
    struct RTCBuildPrimitive *list = aligned_alloc(32, room * sizeof *list);
    if (!list)
        return NULL;
    thread_pool_run(b->threads, b->count, 1024, make_primitives, &(struct primitives){a, list});
    return list;
}

/* How far the middle of a face lies outside of a leaf's part, squared. */
static double outside(const struct builder *a, const struct cut *leaf)
{
    const struct item *x = &a->b->items[leaf->face];
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        double c = (item_centre(x, k) - a->origin[k]) * a->scale, d = 0;
        d = c < leaf->box.low[k]    ? leaf->box.low[k] - c
            : c > leaf->box.high[k] ? c - leaf->box.high[k]
                                    : 0;
        sum += d * d;
    }
    return sum;
}

/* Is leaf c a better place for its face than leaf d? Ties go to the smaller box corner, so that
 * no order of calls counts. */
static int better(const struct builder *a, const struct cut *c, const struct cut *d)
{
    double x = outside(a, c), y = outside(a, d);
    if (x < y || x > y)
        return x < y;
    for (int k = 0; k < 3; k++)
        if (c->box.low[k] < d->box.low[k] || c->box.low[k] > d->box.low[k])
            return c->box.low[k] < d->box.low[k];
    return 0;
}

static void choose_keepers(struct builder *a, const struct cut *c)
{
    if (!c->children && (!a->keeper[c->face] || better(a, c, a->keeper[c->face])))
        a->keeper[c->face] = c;
    for (uint32_t i = 0; i < c->children; i++)
        choose_keepers(a, c->child[i]);
}

/* Drop what holds no face, skip what holds one child, sort. Returns the node that stands here
 * now, NULL when there is none. */
static struct cut *prune(const struct builder *a, struct cut *c)
{
    uint32_t n = 0;
    if (!c->children)
        return a->keeper[c->face] == c ? c : NULL;
    uint32_t j;
    for (uint32_t i = 0; i < c->children; i++) {
        struct cut *x = prune(a, c->child[i]);
        if (!x)
            continue;
        for (j = n++; j > 0 && c->child[j - 1]->face > x->face; j--)
            c->child[j] = c->child[j - 1];
        c->child[j] = x;
    }
    c->children = n;
    if (n < 2)
        return n ? c->child[0] : NULL;
    c->face = c->child[0]->face;
    return c;
}

/* Pack what is below c into node `at`, and sort the items. */
static void pack(struct builder *a, const struct cut *c, uint32_t at)
{
    struct own *own = a->own;
    uint32_t first = own->count;
    if (!c->children)
        a->sorted[a->placed++] = a->b->items[c->face];
    own->count += c->children;
    own->nodes[at].child = first;
    own->nodes[at].children = c->children;
    for (uint32_t i = 0; i < c->children; i++)
        pack(a, c->child[i], first + i);
    own->nodes[at].to = a->placed;
}

static struct cut *build(struct builder *a, RTCDevice device, RTCBVH bvh,
                         struct RTCBuildPrimitive *list, size_t room)
{
    struct RTCBuildArguments how = rtcDefaultBuildArguments();
    how.buildQuality = RTC_BUILD_QUALITY_HIGH;
    how.maxBranchingFactor = FANOUT;
    how.maxDepth = DEEPEST;
    how.minLeafSize = how.maxLeafSize = 1;
    how.bvh = bvh;
    how.primitives = list;
    how.primitiveCount = a->b->count;
    how.primitiveArrayCapacity = room;
    how.createNode = create_node;
    how.setNodeChildren = set_children;
    how.setNodeBounds = set_bounds;
    how.createLeaf = create_leaf;
    how.splitPrimitive = split;
    how.userPtr = a;
    struct cut *root = rtcBuildBVH(&how);
    return rtcGetDeviceError(device) == RTC_ERROR_NONE && !a->failed ? root : NULL;
}

static void close(struct build *b)
{
    struct own *own = b->own;
    if (own)
        free(own->nodes);
    free(own);
    b->own = NULL;
}

static int open(struct build *b)
{
    struct builder a = {.b = b, .sorted = b->scratch};
    size_t room = b->count + (size_t)(SPLITS * b->count) + 1;
    struct RTCBuildPrimitive *list = NULL;
    RTCDevice device = rtcNewDevice(b->threads == 1 ? "threads=1,set_affinity=0" : NULL);
    RTCBVH bvh = device ? rtcNewBVH(device) : NULL;
    struct cut *root = NULL;
    double size = 0;
    struct bounds all;
    bounds_empty(&all);
    for (uint32_t i = 0; i < b->count; i++)
        bounds_add(&all, &b->items[i].box);
    for (int k = 0; k < 3; k++) {
        a.origin[k] = 0.5 * (all.low[k] + all.high[k]);
        size = fmax(size, all.high[k] - all.low[k]);
    }
    int e;
    frexp(size, &e);
    a.scale = size > 0 ? ldexp(1, 1 - e) : 1;
    a.own = b->own = calloc(1, sizeof *a.own);
    a.keeper = calloc(b->count, sizeof *a.keeper);
    list = primitives(&a, room);
    if (a.own)
        a.own->nodes = malloc(2 * (size_t)b->count * sizeof *a.own->nodes);
    if (bvh && a.own && a.own->nodes && a.keeper && list && embree_has_memory(room))
        root = build(&a, device, bvh, list, room);
    if (root) {
        choose_keepers(&a, root);
        a.own->count = 1;
        pack(&a, prune(&a, root), 0);
        memcpy(b->items, a.sorted, b->count * sizeof *b->items);
    }
    free(list);
    free(a.keeper);
    if (bvh)
        rtcReleaseBVH(bvh);
    if (device)
        rtcReleaseDevice(device);
    if (!root)
        close(b);
    return root ? 0 : -1;
}

static int divide(const struct build *b, const struct part *whole, struct part *parts, int threads)
{
    const struct own *own = b->own;
    const struct packed *n = &own->nodes[whole->at];
    (void)threads;
    for (uint32_t i = 0; i < n->children; i++) {
        parts[i] = *whole;
        parts[i].at = n->child + i;
        parts[i].from = i ? parts[i - 1].to : whole->from;
        parts[i].to = own->nodes[n->child + i].to;
    }
    return (int)n->children;
}

const struct strategy build_embree = {open, divide, close};
