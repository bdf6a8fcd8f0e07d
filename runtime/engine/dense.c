/* dense.c - the equation as a matrix over the leaves, solved by LU.
 *
 * 1 - K: row i is what leaf i gathers of each leaf j, over its own links and those of the elements
 * that hold it, by the weights that row_sums.c gives either, and what is shared out on its face. A
 * link from s to r stands for all pairs of leaves below the two: leaf j has its share of s's mean.
 * So links fill the matrix once, in the order of the leaves, and its bands differ by the
 * reflectance alone. Where clusters are linked the same holds of each link's J and of what it
 * brings (separable_links.h).
 *
 * Its diagonal dominates, for rows of K sum to less than 1 (transport.c): LU neither fails nor
 * loses digits. The matrix is made anew for each band, since no room is had for two.
 * [Dense solution: Goral et al. 1984; LAPACK for LU]
 * SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "engine/dense.h"
#include "engine/push_pull.h"
#include "util/lapack_library.h"

struct dense {
    struct lapack lapack;
    const struct light_operator *op;
    uint32_t count;
    uint32_t *leaf;      /* [count]: elements; those of one element follow each other */
    uint32_t *from, *to; /* [element]: its leaves are from .. to - 1 */
    double *matrix;      /* [count * count], row by row */
    double *shared;      /* [face's rows share it; count]: of each leaf, what row_share deals out */
};

uint32_t dense_leaves(const struct hierarchy *h)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < h->count; i++)
        count += h->elements[i].vertices && !h->elements[i].children;
    return count;
}

int dense_too_many(uint32_t leaves, char *cause, size_t size)
{
    if (leaves <= DENSE_LEAVES)
        return 0;
    snprintf(cause, size,
             "LU solves for at most %d leaves, and there are %u already; coarser oracle parameters "
             "make fewer, and the other solvers take any number",
             DENSE_LEAVES, (unsigned)leaves);
    return 1;
}

/* Number the leaves of e. */
static void number(struct dense *d, uint32_t e)
{
    const struct element *at = &d->op->hierarchy->elements[e];
    d->from[e] = d->count;
    for (int c = 0; c < at->children; c++)
        number(d, at->child + (uint32_t)c);
    if (!at->children)
        d->leaf[d->count++] = e;
    d->to[e] = d->count;
}

/* The weight of leaf j in the mean of s. */
static double share_of(const struct dense *d, uint32_t j, uint32_t s)
{
    return d->leaf[j] == s ? 1 : operator_share(d->op, d->leaf[j], s);
}

/* e gathers `weight` of the mean of s: on the leaves of e, and on what is shared out there. */
static void add(struct dense *d, uint32_t e, uint32_t s, double weight)
{
    const struct light_operator *op = d->op;
    const int closes = op->problem->options.closure == CLOSURE_ROWS;
    for (uint32_t i = d->from[e]; i < d->to[e] && weight != 0; i++) {
        uint32_t leaf = d->leaf[i];
        double scale = leaf == e ? op->row_scale[leaf] : op->row_above[leaf],
               bare = weight * operator_bare(op, leaf, e),
               spare = op->hierarchy->elements[leaf].area * (closes ? scale : 1 - scale),
               *row = &d->matrix[(size_t)i * d->count];
        for (uint32_t j = d->from[s]; j < d->to[s]; j++) {
            double part = bare * share_of(d, j, s);
            row[j] += scale * part;
            d->shared[j] += spare * part;
        }
    }
}

/* Over the links of e between surfaces, and those of its parts. */
static void add_links(struct dense *d, uint32_t e)
{
    const struct refinement *r = d->op->refinement;
    const struct element *elements = d->op->hierarchy->elements;
    for (size_t i = r->first_link[e]; i < r->first_link[e + 1]; i++)
        if (elements[r->links[i].emitter].vertices)
            add(d, e, r->links[i].emitter, operator_weight(d->op, i));
    for (int c = 0; c < elements[e].children; c++)
        add_links(d, elements[e].child + (uint32_t)c);
}

/* Over the separable links of `up`, which is e or a cluster that holds the face e. */
static void add_separable(struct dense *d, uint32_t e, uint32_t up)
{
    const struct separable_links *s = &d->op->separable;
    const struct hierarchy *h = d->op->hierarchy;
    if (s->count == 0 || up >= s->elements)
        return;
    for (size_t b = s->first[up]; b < s->first[up + 1]; b++) {
        uint32_t emitter = s->links[b].emitter;
        double takes = separable_links_takes(s, b, e);
        if (h->elements[emitter].depth > 0)
            add(d, e, emitter, takes * separable_links_sends(s, b, emitter));
        else
            for (uint32_t i = h->range[emitter].from; i < h->range[emitter].to; i++) {
                uint32_t face = h->face_element[h->order[i]];
                add(d, e, face, takes * separable_links_sends(s, b, face));
            }
    }
}

static void add_separable_below(struct dense *d, uint32_t e)
{
    const struct element *at = &d->op->hierarchy->elements[e];
    add_separable(d, e, e);
    for (int c = 0; c < at->children; c++)
        add_separable_below(d, at->child + (uint32_t)c);
}

/* The rows of a face's leaves: what each gathers, per uncovered area; then 1 - K of band k. */
static void fill(struct dense *d, const struct transport *x, uint32_t face, uint32_t k)
{
    const struct light_operator *op = d->op;
    const struct element *elements = op->hierarchy->elements;
    uint32_t e = op->hierarchy->face_element[face];
    double rho = x->reflectance[(size_t)face * x->bands + k];
    memset(d->shared, 0, d->count * sizeof *d->shared);
    add_links(d, e);
    add_separable_below(d, e);
    for (uint32_t up = e; up != 0;) {
        up = elements[up].parent;
        add_separable(d, e, up);
    }
    for (uint32_t i = d->from[e]; i < d->to[e]; i++) {
        double *row = &d->matrix[(size_t)i * d->count], uncovered = op->uncovered[d->leaf[i]],
               share = op->row_share[d->leaf[i]];
        for (uint32_t j = 0; j < d->count; j++) {
            double sum = share * d->shared[j];
            row[j] = -rho * (uncovered > 0 ? (row[j] + sum) / uncovered : sum);
        }
        row[i] += 1;
    }
}

static void put_means(const struct dense *d, const struct transport *x, uint32_t e)
{
    const struct element *at = &d->op->hierarchy->elements[e];
    for (int c = 0; c < at->children; c++)
        put_means(d, x, at->child + (uint32_t)c);
    if (at->children)
        element_average(d->op, x, e);
}

/* Returns 0 or -1. */
static int solve_band(struct dense *d, const struct transport *x, uint32_t k, double *solution,
                      lapack_int *pivots)
{
    const struct hierarchy *h = d->op->hierarchy;
    const lapack_int n = (lapack_int)d->count;
    memset(d->matrix, 0, (size_t)d->count * d->count * sizeof *d->matrix);
    for (uint32_t i = 0; i < h->face_count; i++)
        fill(d, x, i, k);
    for (uint32_t i = 0; i < d->count; i++) {
        size_t of = x->by_element ? d->leaf[i] : h->elements[d->leaf[i]].face;
        solution[i] = x->source[of * x->bands + k];
    }
    /* rows of ours are columns of LAPACK's: it has the transposed matrix */
    if (d->lapack.factor(LAPACK_COL_MAJOR, n, n, d->matrix, n, pivots) != 0
        || d->lapack.solve(LAPACK_COL_MAJOR, 'T', n, 1, d->matrix, n, pivots, solution, n) != 0)
        return -1;
    for (uint32_t i = 0; i < d->count; i++)
        x->value[(size_t)d->leaf[i] * x->bands + k] = solution[i];
    return 0;
}

int dense_solve(const struct light_operator *op, struct transport *x)
{
    const struct hierarchy *h = op->hierarchy;
    const size_t leaves = dense_leaves(h);
    struct dense d = {.op = op,
                      .leaf = malloc(leaves * sizeof *d.leaf),
                      .from = malloc(h->count * sizeof *d.from),
                      .to = malloc(h->count * sizeof *d.to),
                      .matrix = malloc(leaves * leaves * sizeof *d.matrix),
                      .shared = malloc(leaves * sizeof *d.shared)};
    double *solution = malloc(leaves * sizeof *solution);
    lapack_int *pivots = malloc(leaves * sizeof *pivots);
    int status = -1;
    if (leaves <= DENSE_LEAVES && !lapack_load(&d.lapack) && d.leaf && d.from && d.to && d.matrix
        && d.shared && solution && pivots) {
        for (uint32_t i = 0; i < h->face_count; i++)
            number(&d, h->face_element[i]);
        status = 0;
        for (uint32_t k = 0; k < x->bands && status == 0; k++)
            status = solve_band(&d, x, k, solution, pivots);
        for (uint32_t i = 0; i < h->face_count && status == 0; i++)
            put_means(&d, x, h->face_element[i]);
    }
    free(d.leaf);
    free(d.from);
    free(d.to);
    free(d.matrix);
    free(d.shared);
    free(solution);
    free(pivots);
    return status;
}
