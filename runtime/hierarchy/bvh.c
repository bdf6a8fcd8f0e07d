/* bvh.c - the driver of the strategies: levels of the tree, each divided.
 *
 * Nodes of a level are divided in parallel, or the few large ones at the top one after the other by
 * all threads; then their children get their places in order. Invariant: places depend on the
 * answers alone, and a strategy's answer on the part alone; so the tree is the same for any number
 * of threads.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "hierarchy/bvh_strategy.h"
#include "kernel/constants.h"
#include "hierarchy/hierarchy.h"
#include "util/thread_pool.h"

/* Nodes divided between two serial steps; items above which all threads share one. */
enum { BLOCK = 4096, LARGE = 1 << 16 };

const char *const clustering_names[] = {
#define X(constant, name, help) #name,
    CLUSTERINGS(X)
#undef X
};

const char *const clustering_helps[] = {
#define X(constant, name, help) help,
    CLUSTERINGS(X)
#undef X
};

static const struct strategy *const strategies[] = {
#define X(constant, name, help) &build_##name,
    CLUSTERINGS(X)
#undef X
};

int clustering_of(const char *name)
{
    for (int i = 0; i < CLUSTERING_COUNT; i++)
        if (strcmp(name, clustering_names[i]) == 0)
            return i;
    return -1;
}

enum clustering clustering_chosen(enum clustering strategy, uint32_t count)
{
    return strategy != CLUSTERING_DEFAULT ? strategy
           : count < CLUSTERS_FACES       ? CLUSTERING_HALVES
                                          : CLUSTERING_SAH;
}

void bounds_empty(struct bounds *b)
{
    for (int k = 0; k < 3; k++) {
        b->low[k] = INFINITY;
        b->high[k] = -INFINITY;
    }
}

void bounds_add(struct bounds *b, const struct bounds *other)
{
    for (int k = 0; k < 3; k++) {
        b->low[k] = other->low[k] < b->low[k] ? other->low[k] : b->low[k];
        b->high[k] = other->high[k] > b->high[k] ? other->high[k] : b->high[k];
    }
}

double bounds_area(const struct bounds *b)
{
    double x = b->high[0] - b->low[0], y = b->high[1] - b->low[1], z = b->high[2] - b->low[2];
    return x < 0 ? 0 : x * y + y * z + z * x;
}

void build_sort(const struct build *b, const struct part *part, int kinds, build_kind *kind,
                const void *context, uint32_t *count)
{
    uint32_t place[KINDS_MAX], from = part->from;
    memset(count, 0, (size_t)kinds * sizeof *count);
    for (uint32_t i = part->from; i < part->to; i++)
        count[kind(&b->items[i], context)]++;
    for (int k = 0; k < kinds; k++) {
        place[k] = from;
        from += count[k];
    }
    for (uint32_t i = part->from; i < part->to; i++)
        b->scratch[place[kind(&b->items[i], context)]++] = b->items[i];
    memcpy(&b->items[part->from], &b->scratch[part->from],
           (part->to - part->from) * sizeof *b->items);
}

int build_cut_thrice(const struct build *b, const struct part *whole, struct part *parts,
                     int threads, build_cutter *cut)
{
    int n = 1;
    parts[0] = *whole;
    for (int i = 0; i < 3; i++) {
        int most = 0;
        for (int k = 1; k < n; k++)
            if (parts[k].to - parts[k].from > parts[most].to - parts[most].from)
                most = k;
        if (parts[most].to - parts[most].from < 2)
            break;
        struct part made[PARTS_MAX];
        int more = cut(b, &parts[most], made, threads);
        memmove(&parts[most + more], &parts[most + 1], (size_t)(n - most - 1) * sizeof *parts);
        memcpy(&parts[most], made, (size_t)more * sizeof *made);
        n += more - 1;
    }
    return n;
}

/* Two halves of the part, as it lies. */
static int halve(const struct part *whole, struct part *parts)
{
    parts[0] = parts[1] = *whole;
    parts[0].to = parts[1].from = whole->from + (whole->to - whole->from) / 2;
    return 2;
}

static int divide(const struct build *b, const struct strategy *s, const struct part *whole,
                  struct part *parts, uint32_t depth, int threads)
{
    int n = depth < DEPTH_MAX ? s->divide(b, whole, parts, threads) : 0;
    return n < 2 ? halve(whole, parts) : n;
}

static void take_items(const void *build, size_t from, size_t to)
{
    const struct build *b = build;
    for (uint32_t i = (uint32_t)from; i < to; i++) {
        const struct face *f = &b->faces[i];
        struct item *x = &b->items[i];
        memcpy(x->box.low, f->vertex[0], sizeof x->box.low);
        memcpy(x->box.high, f->vertex[0], sizeof x->box.high);
        for (uint32_t j = 1; j < f->vertices; j++)
            for (int k = 0; k < 3; k++) {
                double p = f->vertex[j][k];
                x->box.low[k] = p < x->box.low[k] ? p : x->box.low[k];
                x->box.high[k] = p > x->box.high[k] ? p : x->box.high[k];
            }
        x->face = i;
    }
}

/* The parts that are still to be divided, all of one depth, and the nodes that they are. */
struct level {
    struct part *open; /* [count], of two items at least */
    uint32_t *node;    /* [count] */
    uint32_t count;
};

/* What came of the parts that are divided together. */
struct block {
    struct part (*parts)[PARTS_MAX]; /* [BLOCK] */
    int *found;                      /* [BLOCK]: how many */
};

struct dividing {
    const struct build *b;
    const struct strategy *s;
    const struct part *open;
    const struct block *block;
    uint32_t depth;
};

static void divide_parts(const void *dividing, size_t from, size_t to)
{
    const struct dividing *d = dividing;
    for (size_t i = from; i < to; i++)
        if (!d->block->found[i])
            d->block->found[i] = divide(d->b, d->s, &d->open[i], d->block->parts[i], d->depth, 1);
}

/* Divide n open parts: large ones one after the other, by all threads, then the others side by
 * side. */
static void divide_block(const struct build *b, const struct strategy *s, const struct part *open,
                         uint32_t n, uint32_t depth, const struct block *block)
{
    for (uint32_t i = 0; i < n; i++)
        block->found[i] = open[i].to - open[i].from > LARGE
                              ? divide(b, s, &open[i], block->parts[i], depth, b->threads)
                              : 0;
    const struct dividing d = {b, s, open, block, depth};
    thread_pool_run(b->threads, n, 16, divide_parts, &d);
}

/* Append the children of a node; those of two items and more are for the next level. */
static void add_children(struct bvh *t, uint32_t node, const struct part *parts, int count,
                         struct level *next)
{
    t->nodes[node].child = t->count;
    t->nodes[node].children = (uint32_t)count;
    for (int k = 0; k < count; k++) {
        const struct part *p = &parts[k];
        t->nodes[t->count] = (struct bvh_node){p->from, p->to, 0, 0};
        if (p->to - p->from > 1) {
            next->open[next->count] = *p;
            next->node[next->count++] = t->count;
        }
        t->count++;
    }
}

/* Divide the nodes of a level; `next` receives the level below. */
static void grow_level(struct bvh *t, const struct build *b, const struct strategy *s,
                       const struct level *level, struct level *next, const struct block *block)
{
    next->count = 0;
    for (uint32_t from = 0; from < level->count; from += BLOCK) {
        uint32_t n = level->count - from < BLOCK ? level->count - from : BLOCK;
        divide_block(b, s, &level->open[from], n, t->depth, block);
        for (uint32_t i = 0; i < n; i++)
            add_children(t, level->node[from + i], block->parts[i], block->found[i], next);
    }
}

/* The levels, from the root down. Returns 0 or -1. */
static int grow(struct bvh *t, const struct build *b, const struct strategy *s)
{
    /* Open parts have two items at least, so there are no more than half as many. */
    size_t most = b->count / 2 + 1;
    struct level level[2];
    for (int k = 0; k < 2; k++)
        level[k] = (struct level){malloc(most * sizeof *level[k].open),
                                  malloc(most * sizeof *level[k].node), 0};
    struct block block = {malloc(BLOCK * sizeof *block.parts), malloc(BLOCK * sizeof *block.found)};
    int now = 0, result = -1;
    if (!level[0].open || !level[1].open || !level[0].node || !level[1].node || !block.parts
        || !block.found)
        goto done;
    struct part all = {.to = b->count};
    bounds_empty(&all.cell);
    for (uint32_t i = 0; i < b->count; i++)
        bounds_add(&all.cell, &b->items[i].box);
    t->nodes[0] = (struct bvh_node){0, b->count, 0, 0};
    t->count = t->depth = 1;
    if (b->count == 1) { /* the root is a cluster, whatever it holds */
        t->nodes[1] = t->nodes[0];
        t->nodes[0].child = t->nodes[0].children = 1;
        t->count = t->depth = 2;
    } else {
        level[0].open[0] = all;
        level[0].node[0] = 0;
        level[0].count = 1;
    }
    for (; level[now].count > 0; t->depth++) {
        grow_level(t, b, s, &level[now], &level[!now], &block);
        now = !now;
    }
    result = 0;
done:
    for (int k = 0; k < 2; k++) {
        free(level[k].open);
        free(level[k].node);
    }
    free(block.parts);
    free(block.found);
    return result;
}

/* Boxes from the leaves up. */
static void take_boxes(struct bvh *t, const struct build *b)
{
    for (uint32_t i = t->count; i-- > 0;) {
        const struct bvh_node *n = &t->nodes[i];
        if (!n->children) {
            t->boxes[i] = b->items[n->from].box;
            continue;
        }
        t->boxes[i] = t->boxes[n->child];
        for (uint32_t k = 1; k < n->children; k++)
            bounds_add(&t->boxes[i], &t->boxes[n->child + k]);
    }
}

int bvh_build(struct bvh *t, const struct face *faces, uint32_t count, enum clustering strategy,
              int threads)
{
    const struct strategy *s = strategies[clustering_chosen(strategy, count)];
    struct build b = {.faces = faces, .count = count, .threads = threads};
    int result = -1;
    memset(t, 0, sizeof *t);
    if (count == 0 || count > UINT32_MAX / 4)
        return -1;
    b.items = malloc(count * sizeof *b.items);
    b.scratch = malloc(count * sizeof *b.scratch);
    t->nodes = malloc(2 * (size_t)count * sizeof *t->nodes);
    if (!b.items || !b.scratch || !t->nodes)
        goto done;
    thread_pool_run(threads, count, 1024, take_items, &b);
    if (s->open && s->open(&b) < 0)
        goto done;
    result = grow(t, &b, s);
    if (s->close)
        s->close(&b);
    free(b.scratch);
    b.scratch = NULL;
    t->order = malloc(count * sizeof *t->order);
    t->boxes = malloc(t->count * sizeof *t->boxes);
    if (!t->order || !t->boxes)
        result = -1;
    if (result < 0)
        goto done;
    for (uint32_t i = 0; i < count; i++)
        t->order[i] = b.items[i].face;
    take_boxes(t, &b);
done:
    free(b.items);
    free(b.scratch);
    if (result < 0)
        bvh_free(t);
    return result;
}

void bvh_free(struct bvh *t)
{
    free(t->order);
    free(t->nodes);
    free(t->boxes);
    memset(t, 0, sizeof *t);
}
