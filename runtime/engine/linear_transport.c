/* linear_transport.c - sweeps over the links with linear functions: gather, push down, pull up.
 *
 * As transport.c, with three numbers per band for one: a gather multiplies by the 3 x 3 coupling of
 * the link, a push restricts the irradiance to each part exactly, a pull projects the parts'
 * radiosities onto the parent's three functions. A leaf that a solid covers in part, and exitance,
 * are constant; the covered part of a leaf counts for its parent's slope as the parent's mean.
 *
 * When to stop. Exact couplings are a projection of K, whose norm in L2 is at most rho; with it, of
 * changes d, what is left is at most rho / (1 - rho) |d|, and that, in L2 over the mean of x, is
 * what the tolerance is held against: an estimate, since visibilities and form factors are not
 * exact. Should changes grow, one starts again with all couplings limited (linear_coupling.h). Then
 * K is nonnegative, its rows at most 1 + (1 - rho) LINEAR_ROW_EXCESS at every corner, so that its
 * norm is below 1 in the maximum norm, on functions that have their extremes at corners: sweeps
 * converge whatever the oracle has done.
 * SPDX-License-Identifier: MIT */
#include "engine/linear_transport.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "kernel/constants.h"

enum { BLOCKS = 16, LINKS_WORTH_THREADS = 1 << 16 };

/* A function over a surface in each band. */
struct piece {
    double b[3][3];
};

static struct piece load(const double *means, const double *slopes, uint32_t bands, uint32_t e)
{
    struct piece p = {0};
    for (uint32_t k = 0; k < bands; k++) {
        size_t at = (size_t)e * bands + k;
        p.b[k][0] = means[at];
        p.b[k][1] = slopes[2 * at];
        p.b[k][2] = slopes[2 * at + 1];
    }
    return p;
}

static void save(const struct piece *p, double *means, double *slopes, uint32_t bands, uint32_t e)
{
    for (uint32_t k = 0; k < bands; k++) {
        size_t at = (size_t)e * bands + k;
        means[at] = p->b[k][0];
        slopes[2 * at] = p->b[k][1];
        slopes[2 * at + 1] = p->b[k][2];
    }
}

/* One sweep's arguments. */
struct sweep {
    const struct light_operator *op;
    const struct linear_links *links;
    const struct linear_transport *x;
    uint32_t bands;
};

static void gather_below(const struct sweep *s, uint32_t e)
{
    const struct element *at = &s->op->hierarchy->elements[e];
    struct piece h = {0};
    double over_clusters[3] = {0, 0, 0};
    linear_links_gather(s->links, s->op, s->bands, e, s->x->means->value, s->x->value, h.b);
    separable_links_gather(&s->op->separable, (int)s->bands, e, over_clusters);
    for (uint32_t k = 0; k < s->bands; k++)
        h.b[k][0] += over_clusters[k];
    save(&h, s->x->means->irradiance, s->x->irradiance, s->bands, e);
    for (int c = 0; c < at->children; c++)
        gather_below(s, at->child + (uint32_t)c);
}

/* Push irradiance down to the leaves and scale it there; spare: as in transport.c. */
static void push(const struct sweep *s, uint32_t e, const struct piece *above, double spare[3])
{
    const struct light_operator *op = s->op;
    const struct element *at = &op->hierarchy->elements[e];
    struct piece own = load(s->x->means->irradiance, s->x->irradiance, s->bands, e), all = own;
    for (uint32_t k = 0; k < s->bands; k++)
        for (int a = 0; a < 3; a++)
            all.b[k][a] += above->b[k][a];
    for (int c = 0; c < at->children; c++) {
        uint32_t child = at->child + (uint32_t)c;
        struct piece on_child = {0};
        for (uint32_t k = 0; k < s->bands; k++)
            linear_links_restrict(s->links, op->hierarchy, e, child, all.b[k], on_child.b[k]);
        push(s, child, &on_child, spare);
    }
    if (at->children)
        return;
    for (uint32_t k = 0; k < s->bands; k++) {
        double before = all.b[k][0];
        for (int a = 0; a < 3; a++)
            all.b[k][a] = above->b[k][a] * op->row_above[e] + own.b[k][a] * op->row_scale[e];
        double h = all.b[k][0];
        spare[k] += at->area * (op->problem->options.closure == CLOSURE_ROWS ? h : before - h);
    }
    save(&all, s->x->means->irradiance, s->x->irradiance, s->bands, e);
}

/* Set element e to the projection of its children. */
static void project(const struct sweep *s, uint32_t e)
{
    const struct light_operator *op = s->op;
    const struct element *elements = op->hierarchy->elements, *at = &elements[e];
    struct piece mean = {0}, received = {0};
    struct two_scale t[4];
    for (int c = 0; c < at->children; c++) {
        uint32_t j = at->child + (uint32_t)c;
        double sent = operator_share(op, j, e), part = elements[j].area / at->area;
        linear_two_scale(&t[c], &s->links->basis[e], at, &s->links->basis[j], &elements[j]);
        for (uint32_t k = 0; k < s->bands; k++) {
            mean.b[k][0] += sent * s->x->means->value[(size_t)j * s->bands + k];
            received.b[k][0] += part * s->x->means->irradiance[(size_t)j * s->bands + k];
        }
    }
    for (int c = 0; c < at->children; c++) {
        uint32_t j = at->child + (uint32_t)c;
        double part = elements[j].area / at->area;
        struct piece x = load(s->x->means->value, s->x->value, s->bands, j),
                     h = load(s->x->means->irradiance, s->x->irradiance, s->bands, j);
        for (uint32_t k = 0; k < s->bands; k++)
            for (int a = 0; a < 2; a++) {
                const double *from = t[c].from[a];
                mean.b[k][a + 1] += part * op->uncovered[j]
                                    * ((x.b[k][0] - mean.b[k][0]) * t[c].mean[a]
                                       + x.b[k][1] * from[0] + x.b[k][2] * from[1]);
                received.b[k][a + 1] +=
                    part * (h.b[k][0] * t[c].mean[a] + h.b[k][1] * from[0] + h.b[k][2] * from[1]);
            }
    }
    save(&mean, s->x->means->value, s->x->value, s->bands, e);
    save(&received, s->x->means->irradiance, s->x->irradiance, s->bands, e);
}

/* What a sweep changes on one face, over uncovered leaves and all bands. */
struct change {
    double mean, square; /* sum A |d mean|, sum A mean of d^2 */
};

/* x = source + rho H at the leaves, projections above. */
static void pull(const struct sweep *s, uint32_t e, const double spare[3], struct change *change)
{
    const struct light_operator *op = s->op;
    const struct element *at = &op->hierarchy->elements[e];
    const struct transport *m = s->x->means;
    if (at->children) {
        for (int c = 0; c < at->children; c++)
            pull(s, at->child + (uint32_t)c, spare, change);
        project(s, e);
        return;
    }
    struct piece x = load(m->value, s->x->value, s->bands, e),
                 h = load(m->irradiance, s->x->irradiance, s->bands, e);
    const double *source = &m->source[(m->by_element ? (size_t)e : (size_t)at->face) * s->bands];
    const double *rho = &m->reflectance[(size_t)at->face * s->bands];
    const struct linear_row *row = &s->links->row[e];
    for (uint32_t k = 0; k < s->bands; k++) {
        double uncovered = op->uncovered[e], shared = spare[k] * op->row_share[e], square = 0;
        h.b[k][0] += uncovered > 0 ? shared : 0;
        for (int a = 0; a < 2; a++)
            h.b[k][a + 1] = row->scale * (h.b[k][a + 1] - row->flat[a] * h.b[k][0]);
        const double next[3] = {source[k]
                                    + rho[k] * (uncovered > 0 ? h.b[k][0] / uncovered : shared),
                                rho[k] * h.b[k][1], rho[k] * h.b[k][2]};
        change->mean += at->area * uncovered * fabs(next[0] - x.b[k][0]);
        for (int a = 0; a < 3; a++) {
            square += (next[a] - x.b[k][a]) * (next[a] - x.b[k][a]);
            x.b[k][a] = next[a];
        }
        change->square += at->area * uncovered * square;
    }
    save(&x, m->value, s->x->value, s->bands, e);
    save(&h, m->irradiance, s->x->irradiance, s->bands, e);
}

/* One sweep over all faces. change: [face]. */
static void sweep(const struct sweep *s, struct change *change)
{
    const struct light_operator *op = s->op;
    const struct solve_options *o = &op->problem->options;
    const uint32_t *element = op->hierarchy->face_element, faces = op->hierarchy->face_count;
    uint32_t blocks = o->solver == RAD_SOLVER_JACOBI ? 1 : faces < BLOCKS ? faces : BLOCKS;
    separable_links_send(&op->separable, (int)s->bands, s->x->means->value);
#pragma omp parallel num_threads(o->threads) if (op->refinement->link_count > LINKS_WORTH_THREADS)
    for (uint32_t block = 0; block < blocks; block++) {
        uint32_t from = (uint32_t)((uint64_t)faces * block / blocks),
                 to = (uint32_t)((uint64_t)faces * (block + 1) / blocks);
#pragma omp for schedule(dynamic, 8)
        for (uint32_t i = from; i < to; i++)
            gather_below(s, element[i]);
#pragma omp for schedule(dynamic, 64)
        for (uint32_t i = from; i < to; i++) {
            static const struct piece nothing;
            double spare[3] = {0, 0, 0};
            push(s, element[i], &nothing, spare);
            change[i] = (struct change){0};
            pull(s, element[i], spare, &change[i]);
        }
    }
}

/* Residual and estimate after a sweep; rho: the largest reflectance. */
static void measure(const struct sweep *s, const struct change *change, double rho)
{
    const struct hierarchy *h = s->op->hierarchy;
    struct transport *m = s->x->means;
    struct change all = {0};
    double power = 0, area = 0;
    for (uint32_t i = 0; i < h->face_count; i++) {
        uint32_t e = h->face_element[i];
        double bare = h->elements[e].area * s->op->uncovered[e];
        all.mean += change[i].mean;
        all.square += change[i].square;
        area += bare;
        for (uint32_t k = 0; k < s->bands; k++)
            power += bare * m->value[(size_t)e * s->bands + k];
    }
    m->residual = power > 0 ? all.mean / power : 0;
    m->bound = power > 0 ? rho / (1 - rho) * sqrt(all.square * area) / power : 0;
}

int linear_transport_solve(const struct light_operator *op, const struct linear_links *l,
                           struct linear_transport *x)
{
    struct transport *m = x->means;
    const struct sweep s = {op, l, x, m->bands};
    struct change *change = malloc(op->hierarchy->face_count * sizeof *change);
    double rho = 0, least = INFINITY;
    int stopped = 0, grows = 0;
    if (!change)
        return -1;
    for (size_t i = 0; i < (size_t)op->hierarchy->face_count * m->bands; i++)
        rho = fmax(rho, m->reflectance[i]);
    m->converged = 0;
    for (m->sweeps = 0;
         m->sweeps < op->problem->options.iterations && !m->converged && !stopped && !grows;) {
        sweep(&s, change);
        measure(&s, change, rho);
        m->sweeps++;
        m->converged = m->bound <= m->tolerance;
        least = fmin(least, m->bound);
        stopped = m->watch && m->watch(m->watch_context, m);
        grows = !l->limited && !(m->bound <= LINEAR_GROWS * least);
    }
    free(change);
    return stopped ? -1 : grows;
}
