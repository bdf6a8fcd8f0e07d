/* transport.c - sweeps over the links: gather, push down, pull up.
 *
 * A sweep gathers H_r += F V x_s over the links of every element, pushes it down to the leaves,
 * where x = source + rho H, and pulls area means up. A sweep goes through the faces in blocks;
 * within a block all gather first and are updated then, so the result is the same for any number of
 * threads. One block is Jacobi's method, many are Gauss-Seidel's.
 *
 * When to stop. A sweep is x_n = s + L x_n + U x_(n-1) with L + U = K >= 0, the operator (L = 0 is
 * Jacobi's); so errors and changes go as e_n = T e_(n-1), d_n = x_n - x_(n-1) = (T - 1) e_(n-1), T
 * = (1 - L)^-1 U. A value of 1 everywhere makes k_i = rho_i row_i at leaf i by K, the rows as
 * row_sums.c leaves them, and no more by T. So with a = max |d_n| / (1 - k),
 *     |e_(n-1)| <= a everywhere,  |e_n| <= a k_i at leaf i,  sum A |e_n| <= a sum A k,
 * and that, over sum A x and summed over bands, is the bound that the tolerance is held against.
 * The largest k may be above rho, for the cap allows rows up to 1 + (1 - rho) / 2; it is below 1
 * all the same. The change is taken in the norm in which K is known to contract, largest modulus;
 * sum A |d| would not do: there its factor is the largest column, and since caps and closure scale
 * rows alone, A_i F_ij = A_j F_ji does not hold and columns may exceed 1.
 * [Arvo et al. 1994, sections 5.3 and 6.3, for the norms; derived here]
 * Where one place is far brighter than the mean the bound is hundreds of times what is left. A
 * rough solve, which another one follows, stops by an estimate: as if every sweep left rho, the
 * largest reflectance, of the change before.
 *
 * A solid may stand on part of a surface, like a table leg on the floor. What it covers receives
 * nothing and sends nothing; rays know that, but a mean over the whole element would send the
 * missing light a second time less. So x is the mean over the uncovered part, and x = source + rho
 * H / uncovered, where H stays the mean over all. (A leaf found wholly covered has no weight in its
 * parent, but may yet be linked by rays that did find it: closure gives it the irradiance of its
 * face too.)
 * [Hanrahan et al. 1991, sections 4 and 5]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include "engine/transport.h"

enum { BLOCKS = 16, LINKS_WORTH_THREADS = 1 << 16 };

/* What element e gathers over its own links, into irradiance[e]. */
static void gather(const struct light_operator *op, const struct transport *x, uint32_t e)
{
    const struct refinement *r = op->refinement;
    double h[3] = {0, 0, 0};
    uint32_t b = x->bands;
    for (size_t i = r->first_link[e]; i < r->first_link[e + 1]; i++) {
        const struct link *l = &r->links[i];
        double weight = (double)l->form_factor * (l->visibility * (1.0 / LINK_VISIBLE));
        const double *from = &x->value[(size_t)l->emitter * b];
        for (uint32_t k = 0; k < b; k++)
            h[k] += weight * from[k];
    }
    separable_links_gather(&op->separable, (int)b, e, h);
    for (uint32_t k = 0; k < b; k++)
        x->irradiance[(size_t)e * b + k] = h[k];
}

static void gather_below(const struct light_operator *op, const struct transport *x, uint32_t e)
{
    const struct element *at = &op->hierarchy->elements[e];
    gather(op, x, e);
    for (int c = 0; c < at->children; c++)
        gather_below(op, x, at->child + (uint32_t)c);
}

/* Push irradiance down to the leaves and scale it there. spare[band] gathers the power (over the
 * face) that row_share gives out again: under closure a blind leaf's share of the mean, else what
 * the cap takes away. */
static void push(const struct light_operator *op, const struct transport *x, uint32_t e,
                 const double above[3], double spare[3])
{
    const struct element *at = &op->hierarchy->elements[e];
    uint32_t b = x->bands;
    double *H = &x->irradiance[(size_t)e * b], h[3];
    for (uint32_t k = 0; k < b; k++)
        h[k] = above[k] + H[k];
    for (int c = 0; c < at->children; c++)
        push(op, x, at->child + (uint32_t)c, h, spare);
    for (uint32_t k = 0; k < b && !at->children; k++) {
        H[k] = above[k] * op->row_above[e] + H[k] * op->row_scale[e];
        spare[k] += at->area * (op->problem->options.closure == CLOSURE_ROWS ? H[k] : h[k] - H[k]);
    }
}

/* Set element e of value and irradiance to the means of its children. */
static void average(const struct light_operator *op, const struct transport *x, uint32_t e)
{
    const struct element *at = &op->hierarchy->elements[e];
    uint32_t b = x->bands;
    double *X = &x->value[(size_t)e * b], *H = &x->irradiance[(size_t)e * b];
    for (uint32_t k = 0; k < b; k++)
        X[k] = H[k] = 0;
    for (int c = 0; c < at->children; c++) {
        uint32_t j = at->child + (uint32_t)c;
        double sent = operator_share(op, j, e),
               received = op->hierarchy->elements[j].area / at->area;
        for (uint32_t k = 0; k < b; k++) {
            X[k] += sent * x->value[(size_t)j * b + k];
            H[k] += received * x->irradiance[(size_t)j * b + k];
        }
    }
}

void transport_average(const struct light_operator *op, struct transport *x)
{
    for (uint32_t e = op->hierarchy->count; e-- > 0;) /* children follow their parents */
        if (!op->hierarchy->elements[e].vertices)
            average(op, x, e);
}

/* What a sweep changes on one face. */
struct change {
    double moved;           /* sum A |dx| over uncovered leaves, all bands */
    double most[3], sum[3]; /* max |dx| / (1 - k) over leaves; sum A k over uncovered leaves */
};

/* x = source + rho H at the leaves, means above. */
static void pull(const struct light_operator *op, const struct transport *x, uint32_t e,
                 const double spare[3], struct change *change)
{
    const struct element *at = &op->hierarchy->elements[e];
    uint32_t b = x->bands;
    double *X = &x->value[(size_t)e * b], *H = &x->irradiance[(size_t)e * b];
    if (at->children) {
        for (int c = 0; c < at->children; c++)
            pull(op, x, at->child + (uint32_t)c, spare, change);
        average(op, x, e);
        return;
    }
    const double *source = &x->source[(x->by_element ? (size_t)e : (size_t)at->face) * b];
    const double *rho = &x->reflectance[(size_t)at->face * b];
    for (uint32_t k = 0; k < b; k++) {
        double uncovered = op->uncovered[e], shared = spare[k] * op->row_share[e];
        H[k] += uncovered > 0 ? shared : 0;
        double next = source[k] + rho[k] * (uncovered > 0 ? H[k] / uncovered : shared);
        double grown = rho[k] * op->row[e], moved = fabs(next - X[k]);
        change->moved += at->area * uncovered * moved;
        change->sum[k] += at->area * uncovered * grown;
        change->most[k] =
            fmax(change->most[k], moved > 0 && !(grown < 1) ? INFINITY : moved / (1 - grown));
        X[k] = next;
    }
}

/* One sweep over all faces. change: [face]. */
static void sweep(const struct light_operator *op, const struct transport *x, struct change *change)
{
    static const double nothing[3] = {0, 0, 0};
    const struct solve_options *o = &op->problem->options;
    const uint32_t *element = op->hierarchy->face_element, faces = op->hierarchy->face_count;
    uint32_t blocks = o->jacobi ? 1 : faces < BLOCKS ? faces : BLOCKS;
    separable_links_send(&op->separable, (int)x->bands, x->value);
#pragma omp parallel num_threads(o->threads) if (op->refinement->link_count > LINKS_WORTH_THREADS)
    for (uint32_t block = 0; block < blocks; block++) {
        uint32_t from = (uint32_t)((uint64_t)faces * block / blocks),
                 to = (uint32_t)((uint64_t)faces * (block + 1) / blocks);
#pragma omp for schedule(dynamic, 8)
        for (uint32_t i = from; i < to; i++)
            gather_below(op, x, element[i]);
#pragma omp for schedule(dynamic, 64)
        for (uint32_t i = from; i < to; i++) {
            double spare[3] = {0, 0, 0};
            push(op, x, element[i], nothing, spare);
            change[i] = (struct change){0};
            pull(op, x, element[i], spare, &change[i]);
        }
    }
}

/* Residual and bound after a sweep. */
static void measure(const struct light_operator *op, struct transport *x,
                    const struct change *change)
{
    const struct hierarchy *h = op->hierarchy;
    struct change all = {0};
    double power = 0, left = 0;
    for (uint32_t i = 0; i < h->face_count; i++) {
        uint32_t e = h->face_element[i];
        all.moved += change[i].moved;
        for (uint32_t k = 0; k < x->bands; k++) {
            power += h->elements[e].area * op->uncovered[e] * x->value[(size_t)e * x->bands + k];
            all.most[k] = fmax(all.most[k], change[i].most[k]);
            all.sum[k] += change[i].sum[k];
        }
    }
    for (uint32_t k = 0; k < x->bands; k++)
        left += all.most[k] > 0 && all.sum[k] > 0 ? all.most[k] * all.sum[k] : 0;
    x->residual = power > 0 ? all.moved / power : 0;
    x->bound = left > 0 ? left / power : 0;
}

int transport_solve(const struct light_operator *op, struct transport *x)
{
    struct change *change = malloc(op->hierarchy->face_count * sizeof *change);
    int stopped = 0;
    if (!change)
        return -1;
    double rho = 0;
    for (size_t i = 0; i < (size_t)op->hierarchy->face_count * x->bands; i++)
        rho = fmax(rho, x->reflectance[i]);
    x->converged = 0;
    for (x->sweeps = 0; x->sweeps < op->problem->options.iterations && !x->converged && !stopped;) {
        sweep(op, x, change);
        measure(op, x, change);
        x->sweeps++;
        x->converged =
            x->rough ? x->residual * rho <= x->tolerance * (1 - rho) : x->bound <= x->tolerance;
        stopped = x->watch && x->watch(x->watch_context, x);
    }
    free(change);
    return stopped ? -1 : 0;
}
