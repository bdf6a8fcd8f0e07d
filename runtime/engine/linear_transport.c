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
#include "engine/extrapolation.h"
#include "kernel/constants.h"
#include "util/thread_pool.h"

/* A function over a surface in each band. */
struct piece {
    double b[3][3];
};

static struct piece load_value(const struct linear_transport *x, uint32_t e)
{
    struct piece p = {0};
    for (uint32_t k = 0; k < x->means->bands; k++)
        for (int a = 0; a < 3; a++)
            p.b[k][a] = x->value[((size_t)e * x->means->bands + k) * 3 + (size_t)a];
    return p;
}

static void save_value(const struct linear_transport *x, const struct piece *p, uint32_t e)
{
    for (uint32_t k = 0; k < x->means->bands; k++)
        for (int a = 0; a < 3; a++)
            x->value[((size_t)e * x->means->bands + k) * 3 + (size_t)a] = p->b[k][a];
}

static struct piece load_irradiance(const struct linear_transport *x, uint32_t e)
{
    struct piece p = {0};
    for (uint32_t k = 0; k < x->means->bands; k++) {
        size_t at = (size_t)e * x->means->bands + k;
        p.b[k][0] = x->means->irradiance[at];
        p.b[k][1] = x->irradiance[2 * at];
        p.b[k][2] = x->irradiance[2 * at + 1];
    }
    return p;
}

static void save_irradiance(const struct linear_transport *x, const struct piece *p, uint32_t e)
{
    for (uint32_t k = 0; k < x->means->bands; k++) {
        size_t at = (size_t)e * x->means->bands + k;
        x->means->irradiance[at] = p->b[k][0];
        x->irradiance[2 * at] = p->b[k][1];
        x->irradiance[2 * at + 1] = p->b[k][2];
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
    linear_links_gather(s->links, s->op, s->bands, e, s->x->value, h.b);
    separable_links_gather(&s->op->separable, (int)s->bands, e, over_clusters);
    for (uint32_t k = 0; k < s->bands; k++)
        h.b[k][0] += over_clusters[k];
    save_irradiance(s->x, &h, e);
    for (int c = 0; c < at->children; c++)
        gather_below(s, at->child + (uint32_t)c);
}

/* Push irradiance down to the leaves and scale it there; spare: as in transport.c. */
static void push(const struct sweep *s, uint32_t e, const struct piece *above, double spare[3])
{
    const struct light_operator *op = s->op;
    const struct element *at = &op->hierarchy->elements[e];
    struct piece own = load_irradiance(s->x, e), all = own;
    for (uint32_t k = 0; k < s->bands; k++)
        for (int a = 0; a < 3; a++)
            all.b[k][a] += above->b[k][a];
    for (int c = 0; c < at->children; c++) {
        uint32_t child = at->child + (uint32_t)c;
        struct piece on_child = {0};
        for (uint32_t k = 0; k < s->bands; k++)
            linear_links_hand_down(s->links, op, e, child, all.b[k], on_child.b[k]);
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
    save_irradiance(s->x, &all, e);
}

/* Set what element e sends to the projection of what its children do. */
static void project(const struct sweep *s, uint32_t e)
{
    const struct light_operator *op = s->op;
    const struct element *elements = op->hierarchy->elements, *at = &elements[e];
    struct piece sent = {0}, part[4];
    for (int c = 0; c < at->children; c++) {
        uint32_t j = at->child + (uint32_t)c;
        part[c] = load_value(s->x, j);
        for (uint32_t k = 0; k < s->bands; k++)
            sent.b[k][0] += operator_share(op, j, e) * part[c].b[k][0];
    }
    for (int c = 0; c < at->children; c++) {
        uint32_t j = at->child + (uint32_t)c;
        double share = elements[j].area / at->area * op->uncovered[j];
        struct two_scale t;
        linear_two_scale(&t, &s->links->basis[e], at, &s->links->basis[j], &elements[j]);
        for (uint32_t k = 0; k < s->bands; k++) {
            const double *x = part[c].b[k];
            for (int a = 0; a < 2; a++)
                sent.b[k][a + 1] += share
                                    * ((x[0] - sent.b[k][0]) * t.mean[a] + x[1] * t.from[a][0]
                                       + x[2] * t.from[a][1]);
        }
    }
    save_value(s->x, &sent, e);
}

/* Set the means of element e to those of its children. */
static void average(const struct sweep *s, uint32_t e)
{
    const struct element *elements = s->op->hierarchy->elements, *at = &elements[e];
    const struct transport *m = s->x->means;
    for (uint32_t k = 0; k < s->bands; k++) {
        double value = 0, irradiance = 0;
        for (uint32_t j = at->child; j < at->child + at->children; j++) {
            value += operator_share(s->op, j, e) * m->value[(size_t)j * s->bands + k];
            irradiance += elements[j].area / at->area * m->irradiance[(size_t)j * s->bands + k];
        }
        m->value[(size_t)e * s->bands + k] = value;
        m->irradiance[(size_t)e * s->bands + k] = irradiance;
    }
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
        average(s, e);
        project(s, e);
        return;
    }
    struct piece x = load_value(s->x, e), h = load_irradiance(s->x, e);
    const double *source = &m->source[(m->by_element ? (size_t)e : (size_t)at->face) * s->bands];
    const double *rho = &m->reflectance[(size_t)at->face * s->bands];
    const struct linear_row *row = &s->links->row[e];
    for (uint32_t k = 0; k < s->bands; k++) {
        double uncovered = op->uncovered[e], shared = spare[k] * op->row_share[e];
        h.b[k][0] += uncovered > 0 ? shared : 0;
        for (int a = 0; a < 2; a++)
            h.b[k][a + 1] = row->scale * (h.b[k][a + 1] - row->flat[a] * h.b[k][0]);
        const double next[3] = {source[k]
                                    + rho[k] * (uncovered > 0 ? h.b[k][0] / uncovered : shared),
                                rho[k] * h.b[k][1], rho[k] * h.b[k][2]};
        double *mean = &m->value[(size_t)e * s->bands + k],
               square = (next[0] - *mean) * (next[0] - *mean);
        change->mean += at->area * uncovered * fabs(next[0] - *mean);
        *mean = x.b[k][0] = next[0];
        for (int a = 0; a < 2; a++) {
            square += (next[a + 1] - x.b[k][a + 1]) * (next[a + 1] - x.b[k][a + 1]);
            x.b[k][a + 1] = next[a + 1];
            x.b[k][0] -= row->flat[a] * next[a + 1];
        }
        change->square += at->area * uncovered * square;
    }
    save_value(s->x, &x, e);
    save_irradiance(s->x, &h, e);
}

/* Of one block. */
struct block {
    const struct sweep *sweep;
    struct change *change; /* [face] */
    const uint32_t *face;  /* [of the block] */
};

static void gather_faces(const void *block, size_t from, size_t to)
{
    const struct block *b = block;
    for (size_t i = from; i < to; i++)
        gather_below(b->sweep, b->sweep->op->hierarchy->face_element[b->face[i]]);
}

static void update_faces(const void *block, size_t from, size_t to)
{
    const struct block *b = block;
    static const struct piece nothing;
    for (size_t i = from; i < to; i++) {
        const uint32_t face = b->face[i], e = b->sweep->op->hierarchy->face_element[face];
        double spare[3] = {0, 0, 0};
        push(b->sweep, e, &nothing, spare);
        b->change[face] = (struct change){0};
        pull(b->sweep, e, spare, &b->change[face]);
    }
}

/* Tell of what a block has become: slopes and what goes with them, and the means, of which groups
 * take light. */
static void tell_block(const struct sweep *s, uint32_t block, double *room)
{
    const struct light_operator *op = s->op;
    shares_tell_block(&op->shares, block, s->x->value, 3 * (size_t)s->bands, room);
    shares_tell_block(&op->shares, block, s->x->means->value, s->bands, room);
}

/* One sweep over all faces. change: [face]. */
static void sweep(const struct sweep *s, struct change *change, double *room)
{
    const struct light_operator *op = s->op;
    const struct shares *shares = &op->shares;
    const struct solve_options *o = &op->problem->options;
    const int threads = operator_threads(op);
    const int jacobi = o->solver == RAD_SOLVER_JACOBI;
    separable_links_send(&op->separable, (int)s->bands, s->x->means->value);
    for (uint32_t i = 0; i < SWEEP_BLOCKS; i++) {
        const uint32_t from = shares->own_first[i],
                       to = shares->own_first[jacobi ? SWEEP_BLOCKS : i + 1];
        const struct block b = {s, change, shares->own + from};
        thread_pool_run(threads, to - from, 8, gather_faces, &b);
        thread_pool_run(threads, to - from, 64, update_faces, &b);
        if (jacobi)
            break;
        tell_block(s, i, room);
    }
    for (uint32_t i = 0; jacobi && i < SWEEP_BLOCKS; i++)
        tell_block(s, i, room);
    shares_tell_groups(shares, s->x->means->value, s->bands, room);
}

/* Residual and estimate after a sweep; rho: the largest reflectance. */
static void measure(const struct sweep *s, const struct change *change, double rho)
{
    const struct hierarchy *h = s->op->hierarchy;
    const struct shares *shares = &s->op->shares;
    struct transport *m = s->x->means;
    enum { MEAN, SQUARE, AREA, POWER, SUMS };
    double all[SUMS] = {0};
    for (uint32_t i = 0; i < h->face_count; i++) {
        uint32_t e = h->face_element[i];
        double bare = h->elements[e].area * s->op->uncovered[e];
        if (!shares_mine(shares, e))
            continue;
        all[MEAN] += change[i].mean;
        all[SQUARE] += change[i].square;
        all[AREA] += bare;
        for (uint32_t k = 0; k < s->bands; k++)
            all[POWER] += bare * fabs(m->value[(size_t)e * s->bands + k]);
    }
    ranks_add(shares->ranks, RANKS_SWEEPS, all, SUMS);
    m->moved = all[MEAN];
    m->residual = all[POWER] > 0 ? all[MEAN] / all[POWER] : 0;
    m->bound = all[POWER] > 0 ? rho / (1 - rho) * sqrt(all[SQUARE] * all[AREA]) / all[POWER] : 0;
}

void linear_transport_start(const struct light_operator *op, const struct linear_links *l,
                            const struct linear_transport *x)
{
    const struct sweep s = {op, l, x, x->means->bands};
    const struct hierarchy *h = op->hierarchy;
    for (uint32_t i = h->count; i-- > 0;) { /* children follow their parents */
        for (uint32_t k = 0; k < s.bands; k++)
            x->value[((size_t)i * s.bands + k) * 3] = x->means->value[(size_t)i * s.bands + k];
        if (h->elements[i].vertices && h->elements[i].children)
            project(&s, i);
    }
}

int linear_transport_solve(const struct light_operator *op, const struct linear_links *l,
                           struct linear_transport *x)
{
    struct transport *m = x->means;
    const struct sweep s = {op, l, x, m->bands};
    struct change *change = malloc(op->hierarchy->face_count * sizeof *change);
    double *room = malloc((shares_room(&op->shares) * 3 * m->bands + 1) * sizeof *room);
    struct stall stall = {.sweeps = 0};
    double rho = 0;
    int stopped = 0, grows = 0;
    const int jacobi = op->problem->options.solver == RAD_SOLVER_JACOBI;
    const size_t values = (size_t)op->hierarchy->count * m->bands;
    struct extrapolation guess = {.steady = 0};
    if (ranks_any(op->shares.ranks, !change || !room)) {
        free(change);
        free(room);
        return -1;
    }
    for (size_t i = 0; i < (size_t)op->hierarchy->face_count * m->bands; i++)
        rho = fmax(rho, m->reflectance[i]);
    m->converged = 0;
    for (m->sweeps = 0;
         m->sweeps < op->problem->options.iterations && !m->converged && !stopped && !grows;) {
        extrapolation_keep(&guess, GUESS_MEANS, m->value, values);
        extrapolation_keep(&guess, GUESS_SLOPES, x->value, 3 * values);
        sweep(&s, change, room);
        measure(&s, change, rho);
        m->sweeps++;
        m->converged = transport_stalled(op, m, &stall) || m->bound <= m->tolerance;
        stopped = m->watch && m->watch(m->watch_context, m);
        grows = !l->limited && !(m->residual <= SOLVE_DOUBLE)
                && !(m->bound <= LINEAR_GROWS * stall.least);
        const double factor = jacobi ? 0 : extrapolation_factor(&guess, m->moved);
        if (factor > 0 && !m->converged) {
            extrapolation_add(&guess, GUESS_MEANS, factor, m->value, values);
            extrapolation_add(&guess, GUESS_SLOPES, factor, x->value, 3 * values);
            shares_tell_groups(&op->shares, m->value, s.bands, room);
        }
    }
    extrapolation_close(&guess);
    free(room);
    free(change);
    return stopped ? -1 : grows;
}
