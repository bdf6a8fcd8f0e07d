/* bvh_strategy.h - what a strategy that builds the tree of clusters must do.
 *
 * It cuts a range of items into parts, again and again; bvh.c asks it, level by level, and makes
 * the tree of the answers.
 * SPDX-License-Identifier: MIT */
#ifndef BUILD_H
#define BUILD_H

#include "hierarchy/bvh.h"

/* A face, as strategies see it. */
struct item {
    struct bounds box;
    uint32_t face;
};

/* A range of items that becomes a node. `at` and `cell` are the strategy's own; the first part
 * has 0 and the box of all. */
struct part {
    uint32_t from, to;
    uint32_t at;
    struct bounds cell;
};

struct build {
    const struct face *faces;
    uint32_t count;
    int threads;
    /* [count]; a part's are neighbours. A strategy moves them within the part it divides */
    struct item *items;
    struct item *scratch; /* [count]; free for use from `from` to `to` of that part */
    void *own;            /* the strategy's */
};

struct strategy {
    int (*open)(struct build *b); /* may be NULL. Returns 0, or -1 when out of memory */
    /* Divide a part of two items or more into parts [at most PARTS_MAX] that cover it in order.
     * Returns how many; fewer than 2: it cannot, and the part is halved as it lies. Called from
     * many threads at once, each with a part of its own, and with threads > 1 from one. The answer
     * may depend on nothing but the part and its items. */
    int (*divide)(const struct build *b, const struct part *whole, struct part *parts, int threads);
    void (*close)(struct build *b); /* may be NULL */
};

/* One file each. */
#define X(constant, name, help) extern const struct strategy build_##name;
CLUSTERINGS(X)
#undef X

static inline double item_centre(const struct item *i, int axis)
{
    return 0.5 * (i->box.low[axis] + i->box.high[axis]);
}

/* Cut items [from, to) in two by the surface-area heuristic over their boxes, keeping their order
 * on each side. Returns where the second begins; the middle when all centres coincide.
 * (bvh_sah.c) */
uint32_t build_cut(const struct build *b, uint32_t from, uint32_t to, int threads);

/* Three cuts, each of the part with the most items. cut() makes 2 or more of one. Returns how
 * many parts there are. */
typedef int build_cutter(const struct build *b, const struct part *whole, struct part *parts,
                         int threads);
int build_cut_thrice(const struct build *b, const struct part *whole, struct part *parts,
                     int threads, build_cutter *cut);

/* Sort a part's items by kind, 0 to kinds - 1, keeping their order otherwise. count[kinds]: how
 * many there are of each. */
typedef int build_kind(const struct item *item, const void *context);
enum { KINDS_MAX = 16 };
void build_sort(const struct build *b, const struct part *part, int kinds, build_kind *kind,
                const void *context, uint32_t *count);

#endif
