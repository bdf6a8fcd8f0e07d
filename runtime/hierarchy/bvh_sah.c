/* bvh_sah.c - clusters by a top-down binned surface-area heuristic [Wald 2007].
 *
 * Items fall into BINS slices of the range of their centres, on each axis; a range is cut at the
 * border between slices where area times number, summed over both sides, is least. Three such cuts
 * of the largest part make four, as many as a split surface has. Invariant: boxes are joined by
 * least and largest, and counts are whole, so it is all the same in which order and by how many
 * threads.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>
#include "hierarchy/bvh_strategy.h"
#include "util/thread_pool.h"

/* ALONE: items below which more threads do not pay. */
enum { BINS = 16, SHARES = 32, ALONE = 1 << 16 };

/* The slices of one axis. A slice that holds nothing has no box. */
struct slices {
    uint32_t count[BINS];
    struct bounds box[BINS];
};

static int slice_of(const struct item *x, int axis, double low, double size)
{
    double bin = (item_centre(x, axis) - low) / size * BINS;
    return bin < BINS ? (int)bin : BINS - 1;
}

static void put(struct slices *s, int bin, uint32_t count, const struct bounds *box)
{
    if (s->count[bin])
        bounds_add(&s->box[bin], box);
    else
        s->box[bin] = *box;
    s->count[bin] += count;
}

static void centres(const struct build *b, uint32_t from, uint32_t to, struct bounds *range)
{
    bounds_empty(range);
    for (uint32_t i = from; i < to; i++)
        for (int k = 0; k < 3; k++) {
            double c = item_centre(&b->items[i], k);
            range->low[k] = c < range->low[k] ? c : range->low[k];
            range->high[k] = c > range->high[k] ? c : range->high[k];
        }
}

static void fill(const struct build *b, uint32_t from, uint32_t to, const struct bounds *range,
                 struct slices slices[3])
{
    for (int k = 0; k < 3; k++) {
        double low = range->low[k], size = range->high[k] - low;
        memset(slices[k].count, 0, sizeof slices[k].count);
        for (uint32_t i = from; i < to && size > 0; i++)
            put(&slices[k], slice_of(&b->items[i], k, low, size), 1, &b->items[i].box);
    }
}

/* What the border tells of each item. */
struct border {
    double low, size;
    int axis, at;
};

/* The cheapest border; `full`: on axes without an empty slice. Returns 0 when there is none. */
static int choose(const struct slices slices[3], const struct bounds *range, uint32_t count,
                  int full, struct border *border)
{
    double best = INFINITY;
    int j;
    for (int k = 0; k < 3; k++) {
        const struct slices *s = &slices[k];
        uint32_t n = 0;
        for (j = 0; full && j < BINS && s->count[j]; j++)
            continue;
        if (full && j < BINS)
            continue;
        struct bounds side;
        bounds_empty(&side);
        double from_right[BINS];
        for (j = BINS - 1; j > 0; j--) {
            if (s->count[j])
                bounds_add(&side, &s->box[j]);
            n += s->count[j];
            from_right[j] = bounds_area(&side) * n;
        }
        bounds_empty(&side);
        for (n = 0, j = 0; j < BINS - 1; j++) {
            if (!s->count[j]) /* the border before it costs the same */
                continue;
            bounds_add(&side, &s->box[j]);
            n += s->count[j];
            double cost = bounds_area(&side) * n + from_right[j + 1];
            if (n < count && cost < best) {
                best = cost;
                *border = (struct border){range->low[k], range->high[k] - range->low[k], k, j + 1};
            }
        }
    }
    return best < INFINITY;
}

static int left_of(const struct item *x, const struct border *c)
{
    return slice_of(x, c->axis, c->low, c->size) < c->at;
}

static uint32_t count_left(const struct build *b, uint32_t from, uint32_t to,
                           const struct border *c)
{
    uint32_t n = 0;
    for (uint32_t i = from; i < to; i++)
        n += (uint32_t)left_of(&b->items[i], c);
    return n;
}

/* Items [from, to) go to scratch, from `left` and `right` on. */
static void part_items(const struct build *b, uint32_t from, uint32_t to, const struct border *c,
                       uint32_t left, uint32_t right)
{
    for (uint32_t i = from; i < to; i++)
        b->scratch[left_of(&b->items[i], c) ? left++ : right++] = b->items[i];
}

static void take_back(const struct build *b, uint32_t from, uint32_t to)
{
    memcpy(&b->items[from], &b->scratch[from], (to - from) * sizeof *b->items);
}

/* Two items are told apart on the first axis on which they can be: all borders between them cost
 * the same. */
static void order_two(struct item *x)
{
    for (int k = 0; k < 3; k++) {
        double first = item_centre(&x[0], k), second = item_centre(&x[1], k);
        if (first > second) {
            struct item swap = x[0];
            x[0] = x[1];
            x[1] = swap;
        }
        if (first < second || first > second)
            return;
    }
}

static uint32_t cut_alone(const struct build *b, uint32_t from, uint32_t to, int full)
{
    if (full && to - from < BINS)
        return from + (to - from) / 2;
    if (to - from == 2) {
        order_two(&b->items[from]);
        return from + 1;
    }
    struct bounds range;
    centres(b, from, to, &range);
    struct slices slices[3];
    fill(b, from, to, &range, slices);
    struct border c;
    if (!choose(slices, &range, to - from, full, &c))
        return from + (to - from) / 2;
    uint32_t left = count_left(b, from, to, &c);
    part_items(b, from, to, &c, from, from + left);
    take_back(b, from, to);
    return from + left;
}

/* One cut by many threads: each step is done in shares, by one thread each, and what shares find is
 * joined in their order. */
struct together {
    const struct build *b;
    struct bounds range;                /* of all centres */
    struct border border;               /* where it is cut */
    uint32_t first[SHARES + 1], middle; /* of each share; of the right side */
    struct share {
        struct bounds range;
        struct slices slices[3];
        uint32_t left; /* items left of the border */
    } * share;         /* [SHARES] */
};

static void find_centres(const void *together, size_t from, size_t to)
{
    const struct together *t = together;
    for (size_t s = from; s < to; s++)
        centres(t->b, t->first[s], t->first[s + 1], &t->share[s].range);
}

static void fill_slices(const void *together, size_t from, size_t to)
{
    const struct together *t = together;
    for (size_t s = from; s < to; s++)
        fill(t->b, t->first[s], t->first[s + 1], &t->range, t->share[s].slices);
}

static void count_shares(const void *together, size_t from, size_t to)
{
    const struct together *t = together;
    for (size_t s = from; s < to; s++)
        t->share[s].left = count_left(t->b, t->first[s], t->first[s + 1], &t->border);
}

static void part_shares(const void *together, size_t from, size_t to)
{
    const struct together *t = together;
    for (size_t s = from; s < to; s++) {
        uint32_t l = t->first[0];
        for (size_t j = 0; j < s; j++)
            l += t->share[j].left;
        part_items(t->b, t->first[s], t->first[s + 1], &t->border, l,
                   t->middle + (t->first[s] - l));
    }
}

static void take_back_shares(const void *together, size_t from, size_t to)
{
    const struct together *t = together;
    for (size_t s = from; s < to; s++)
        take_back(t->b, t->first[s], t->first[s + 1]);
}

static uint32_t cut_together(const struct build *b, uint32_t from, uint32_t to, int full,
                             int threads)
{
    struct share share[SHARES];
    struct together t = {.b = b, .share = share, .middle = from};
    struct slices slices[3];
    for (int s = 0; s <= SHARES; s++)
        t.first[s] = from + (uint32_t)((uint64_t)(to - from) * (uint64_t)s / SHARES);
    thread_pool_run(threads, SHARES, 1, find_centres, &t);
    t.range = share[0].range;
    for (int s = 1; s < SHARES; s++)
        bounds_add(&t.range, &share[s].range);
    for (int k = 0; k < 3; k++)
        memset(slices[k].count, 0, sizeof slices[k].count);
    thread_pool_run(threads, SHARES, 1, fill_slices, &t);
    for (int s = 0; s < SHARES; s++)
        for (int k = 0; k < 3; k++)
            for (int j = 0; j < BINS; j++)
                if (share[s].slices[k].count[j])
                    put(&slices[k], j, share[s].slices[k].count[j], &share[s].slices[k].box[j]);
    if (!choose(slices, &t.range, to - from, full, &t.border))
        return from + (to - from) / 2;
    thread_pool_run(threads, SHARES, 1, count_shares, &t);
    for (int s = 0; s < SHARES; s++)
        t.middle += share[s].left;
    thread_pool_run(threads, SHARES, 1, part_shares, &t);
    thread_pool_run(threads, SHARES, 1, take_back_shares, &t);
    return t.middle;
}

static uint32_t cut(const struct build *b, uint32_t from, uint32_t to, int full, int threads)
{
    return threads > 1 && to - from > ALONE ? cut_together(b, from, to, full, threads)
                                            : cut_alone(b, from, to, full);
}

uint32_t build_cut(const struct build *b, uint32_t from, uint32_t to, int threads)
{
    return cut(b, from, to, 0, threads);
}

static int cut_in_two(const struct build *b, const struct part *whole, struct part *parts,
                      int threads)
{
    parts[0] = parts[1] = *whole;
    parts[0].to = parts[1].from = cut(b, whole->from, whole->to, 0, threads);
    return 2;
}

static int cut_if_full(const struct build *b, const struct part *whole, struct part *parts,
                       int threads)
{
    parts[0] = parts[1] = *whole;
    parts[0].to = parts[1].from = cut(b, whole->from, whole->to, 1, threads);
    return 2;
}

static int divide(const struct build *b, const struct part *whole, struct part *parts, int threads)
{
    return build_cut_thrice(b, whole, parts, threads, cut_in_two);
}

static int divide_if_full(const struct build *b, const struct part *whole, struct part *parts,
                          int threads)
{
    return build_cut_thrice(b, whole, parts, threads, cut_if_full);
}

const struct strategy build_sah = {NULL, divide, NULL};

/* The same, but where every axis has an empty slice, as with less than BINS items, halves of the
 * order at hand: at the bottom, the file's. */
const struct strategy build_halves = {NULL, divide_if_full, NULL};
