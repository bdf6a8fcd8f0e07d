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

static void take_items(struct build *b)
{
#pragma omp parallel for schedule(static) num_threads(b->threads)
    for (uint32_t i = 0; i < b->count; i++) {
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

/* One level: nodes [first, first + count) are open[0 .. count). Their children are appended; those
 * of two items and more are the next level, written to `next`. Returns how many those are. */
static uint32_t grow_level(struct bvh *t, const struct build *b, const struct strategy *s,
                           const struct part *open, const uint32_t *node, uint32_t count,
                           uint32_t depth, struct part (*parts)[PARTS_MAX], int *found,
                           struct part *next, uint32_t *next_node)
{
    uint32_t after = 0;
    for (uint32_t from = 0; from < count; from += BLOCK) {
        uint32_t n = count - from < BLOCK ? count - from : BLOCK;
        for (uint32_t i = 0; i < n; i++) {
            const struct part *p = &open[from + i];
            found[i] = p->to - p->from > LARGE ? divide(b, s, p, parts[i], depth, b->threads) : 0;
        }
#pragma omp parallel for schedule(dynamic, 16) num_threads(b->threads)
        for (uint32_t i = 0; i < n; i++)
            if (!found[i])
                found[i] = divide(b, s, &open[from + i], parts[i], depth, 1);
        for (uint32_t i = 0; i < n; i++) {
            struct bvh_node *parent = &t->nodes[node[from + i]];
            parent->child = t->count;
            parent->children = (uint32_t)found[i];
            for (int k = 0; k < found[i]; k++) {
                const struct part *p = &parts[i][k];
                t->nodes[t->count] = (struct bvh_node){p->from, p->to, 0, 0};
                if (p->to - p->from > 1) {
                    next[after] = *p;
                    next_node[after++] = t->count;
                }
                t->count++;
            }
        }
    }
    return after;
}

/* The levels, from the root down. Returns 0 or -1. */
static int grow(struct bvh *t, const struct build *b, const struct strategy *s)
{
    /* Open parts have two items at least, so there are no more than half as many. */
    size_t most = b->count / 2 + 1;
    struct part *open[2] = {malloc(most * sizeof **open), malloc(most * sizeof **open)};
    uint32_t *node[2] = {malloc(most * sizeof **node), malloc(most * sizeof **node)}, count = 1;
    struct part(*parts)[PARTS_MAX] = malloc(BLOCK * sizeof *parts);
    int *found = malloc(BLOCK * sizeof *found), now = 0, result = -1;
    if (!open[0] || !open[1] || !node[0] || !node[1] || !parts || !found)
        goto done;
    open[0][0] = (struct part){.to = b->count};
    node[0][0] = 0;
    bounds_empty(&open[0][0].cell);
    for (uint32_t i = 0; i < b->count; i++)
        bounds_add(&open[0][0].cell, &b->items[i].box);
    t->nodes[0] = (struct bvh_node){0, b->count, 0, 0};
    t->count = t->depth = 1;
    if (b->count == 1) { /* the root is a cluster, whatever it holds */
        t->nodes[1] = t->nodes[0];
        t->nodes[0].child = t->nodes[0].children = 1;
        t->count = t->depth = 2;
        count = 0;
    }
    for (; count > 0; t->depth++) {
        count = grow_level(t, b, s, open[now], node[now], count, t->depth, parts, found, open[!now],
                           node[!now]);
        now = !now;
    }
    result = 0;
done:
    for (now = 0; now < 2; now++) {
        free(open[now]);
        free(node[now]);
    }
    free(parts);
    free(found);
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
    const struct strategy *s = strategies[strategy != CLUSTERING_DEFAULT ? strategy
                                          : count < CLUSTERS_FACES       ? CLUSTERING_HALVES
                                                                         : CLUSTERING_SAH];
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
    take_items(&b);
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
