/* own_quarters.c - see own_quarters.h.
 *
 * Which quarters there are is told as trees (tree_bits.h), of leaves that all ranks have, in their
 * order; all split them again in that order, which is the one they were made in. So a rank's own
 * come in the order that it has them in, and values need no names: each rank's, one after the
 * other.
 * SPDX-License-Identifier: MIT */
#include "engine/own_quarters.h"
#include <stdlib.h>
#include <string.h>
#include "engine/row_sums.h"
#include "engine/tree_bits.h"

int own_quarters_begin(struct solve *s, const double *work)
{
    struct ranks *ranks = s->problem.options.ranks;
    struct shares *shares = &s->operator.shares;
    const size_t stretches = ((size_t)ranks_count(ranks) + 1) * sizeof *s->stretch;
    if (ranks_count(ranks) == 1)
        return 0;
    if (!s->stretch)
        s->stretch = malloc(stretches);
    if (ranks_any(ranks, quarters_open(&s->quarters, &s->hierarchy) < 0 || !s->stretch)) {
        quarters_close(&s->quarters);
        return -1;
    }
    memcpy(s->stretch, shares->stretch, stretches);
    shares_divide(shares, work);
    shares->common = s->quarters.common;
    separable_links_close(&s->operator.separable);
    return 0;
}

int own_quarters_tell(struct solve *s, double *values, size_t width)
{
    return own_quarters(s) ? shares_complete(&s->operator.shares, values, width) : 0;
}

void own_quarters_settle(struct solve *s)
{
    struct quarters *q = &s->quarters;
    const struct hierarchy *h = &s->hierarchy;
    uint64_t sums[2] = {h->count - q->common, 0};
    if (!own_quarters(s))
        return;
    for (uint32_t i = 0; i < h->count; i++)
        sums[1] += h->elements[i].vertices && !h->elements[i].children && own_quarters_mine(s, i);
    ranks_add_counts(s->problem.options.ranks, RANKS_VALUES, sums, 2);
    const struct quarters left = {
        .common = q->common, .count = q->common + (uint32_t)sums[0], .leaves = (uint32_t)sums[1]};
    quarters_close(q);
    *q = left;
}

/* While all get them. */
struct sharing {
    struct solve *s;
    struct ranks *ranks;
    uint32_t common;
    size_t *first; /* [ranks + 1]: rank by rank, how many quarters come before; the same of bytes */
    unsigned char *byte;
    size_t *at; /* [ranks]: bits taken; values taken */
};

/* Was it a leaf of what all have? */
static int was_leaf(const struct sharing *x, uint32_t i)
{
    const struct element *e = &x->s->hierarchy.elements[i];
    return e->vertices && (!e->children || e->child >= x->common);
}

static int tell_trees(struct sharing *x)
{
    const struct solve *s = x->s;
    const size_t me = (size_t)ranks_number(x->ranks);
    struct tree_bits b = {0};
    for (uint32_t i = 0; i < x->common; i++)
        if (was_leaf(x, i) && own_quarters_mine(s, i))
            tree_bits_put(&b, &s->hierarchy, i);
    int failed = ranks_any(x->ranks, b.failed);
    if (!failed) {
        ranks_starts(x->ranks, RANKS_VALUES, (b.count + 7) / 8, x->first);
        x->byte = malloc(x->first[ranks_count(x->ranks)] + 1);
        failed = ranks_any(x->ranks, !x->byte);
    }
    if (!failed) {
        if (b.count)
            memcpy(x->byte + x->first[me], b.byte, (b.count + 7) / 8);
        ranks_complete(x->ranks, RANKS_VALUES, x->byte, 1, x->first);
    }
    free(b.byte);
    return failed ? -1 : 0;
}

/* All quarters, in place of the rank's own. */
static int take_trees(struct sharing *x)
{
    struct hierarchy *h = &x->s->hierarchy;
    hierarchy_drop(h, x->common);
    memset(x->at, 0, (size_t)ranks_count(x->ranks) * sizeof *x->at);
    for (uint32_t i = 0; i < x->common; i++)
        if (was_leaf(x, i)) {
            const int owner = shares_owner(&x->s->operator.shares, i);
            if (tree_bits_take(x->byte + x->first[owner], &x->at[owner], h, i) < 0)
                return -1;
        }
    return 0;
}

/* The values of all, rank by rank, of which this rank's stand behind those of common elements; NULL
 * when out of memory. */
static double *collect(const struct sharing *x, const double *values, size_t width)
{
    const size_t *first = x->first, me = (size_t)ranks_number(x->ranks);
    double *all = malloc((first[ranks_count(x->ranks)] * width + 1) * sizeof *all);
    if (ranks_any(x->ranks, !all)) {
        free(all);
        return NULL;
    }
    memcpy(all + first[me] * width, values + x->common * width,
           (first[me + 1] - first[me]) * width * sizeof *all);
    ranks_complete(x->ranks, RANKS_VALUES, all, width * sizeof *all, first);
    return all;
}

/* Each to its place, among the elements that there are now. Frees what was collected. */
static void spread(const struct sharing *x, double *all, double *values, size_t width)
{
    const struct hierarchy *h = &x->s->hierarchy;
    memcpy(x->at, x->first, (size_t)ranks_count(x->ranks) * sizeof *x->at);
    for (uint32_t i = x->common; i < h->count; i++) {
        const int owner = shares_owner(&x->s->operator.shares, i);
        memcpy(&values[i * width], &all[x->at[owner]++ * width], width * sizeof *all);
    }
    free(all);
}

/* Of an array that is as long as there are elements. */
static int share_array(const struct sharing *x, double **values, size_t width)
{
    if (!*values)
        return 0;
    double *all = collect(x, *values, width),
           *larger = all ? realloc(*values, x->s->hierarchy.count * width * sizeof *larger) : NULL;
    if (larger)
        *values = larger;
    if (!all || ranks_any(x->ranks, !larger)) {
        free(all);
        return -1;
    }
    spread(x, all, *values, width);
    return 0;
}

static int share_values(const struct sharing *x)
{
    struct solve *s = x->s;
    const size_t bands = s->problem.bands;
    struct {
        double **values;
        size_t width;
        double *all;
    } of_room[] = {{&s->state.radiosity, bands, NULL},
                   {&s->state.irradiance, bands, NULL},
                   {&s->operator.uncovered, 1, NULL}};
    enum { ARRAYS = sizeof of_room / sizeof *of_room };
    int failed = 0;
    for (int i = 0; i < ARRAYS && !failed; i++) {
        of_room[i].all = collect(x, *of_room[i].values, of_room[i].width);
        failed = !of_room[i].all;
    }
    s->started = x->common;
    failed = ranks_any(x->ranks, failed || solve_make_room(s) < 0);
    for (int i = 0; i < ARRAYS; i++)
        if (failed)
            free(of_room[i].all);
        else
            spread(x, of_room[i].all, *of_room[i].values, of_room[i].width);
    return failed || share_array(x, &s->mended.radiosity, bands) < 0
                   || share_array(x, &s->mended.irradiance, bands) < 0
                   || share_array(x, &s->linear.gradient, 3 * bands) < 0
                   || share_array(x, &s->mended_gradient, 3 * bands) < 0
               ? -1
               : 0;
}

int own_quarters_share(struct solve *s)
{
    struct sharing x = {.s = s, .ranks = s->problem.options.ranks, .common = s->quarters.common};
    if (!own_quarters(s))
        return 0;
    const size_t ranks = (size_t)ranks_count(x.ranks), own = s->hierarchy.count - x.common;
    x.first = calloc(ranks + 1, sizeof *x.first);
    x.at = calloc(ranks, sizeof *x.at);
    int failed = ranks_any(x.ranks, !x.first || !x.at) || tell_trees(&x) < 0
                 || ranks_any(x.ranks, take_trees(&x) < 0);
    if (!failed) {
        ranks_starts(x.ranks, RANKS_VALUES, own, x.first);
        failed = share_values(&x) < 0;
    }
    free(x.byte);
    free(x.first);
    free(x.at);
    quarters_close(&s->quarters);
    s->operator.shares.common = 0;
    shares_restore(&s->operator.shares, s->stretch);
    return failed || ranks_any(s->problem.options.ranks, refinement_sort(&s->refinement) < 0)
                   || row_sums_separate(&s->operator) < 0
               ? -1
               : 0;
}
