/* balance.c - sweeps over the links: gather, push down, pull up.
 *
 * A sweep gathers H_r += F V x_s over the links of every element, pushes it down to the leaves, where
 * x = source + rho H, and pulls area means up. A sweep goes through the faces in blocks; within a block all
 * gather first and are updated then, so the result is the same for any number of threads. One block
 * is Jacobi's method, many are Gauss-Seidel's. With rows at most 1 a sweep contracts by rho, the largest reflectance, so
 * the error left is about residual * rho / (1 - rho), which is what the tolerance is held against.
 *
 * Part of a surface may be buried in a solid that stands on it, like the floor under a table leg. It
 * receives nothing and sends nothing; rays know that, but a mean over the whole element would send the missing light
 * a second time less. So x is the mean over the exposed part, and x = source + rho H / exposed, where H stays the
 * mean over all. (A leaf found wholly buried has no weight in its parent, but may yet be linked by rays that did find
 * it: closure gives it the irradiance of its face too.)
 * [Hanrahan et al. 1991, sections 4 and 5; Arvo et al. 1994, section 5.3 for the bound]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include "engine/transport.h"

enum { BLOCKS = 16, LINKS_WORTH_THREADS = 1 << 16 };

double balance_share(const struct solve *s, uint32_t j, uint32_t e)
{
    double part = s->hierarchy.elements[j].area / s->hierarchy.elements[e].area;
    return s->exposed[e] > 0 ? part * s->exposed[j] / s->exposed[e] : part;
}

/* What element e gathers over its own links, into irradiance[e]. */
static void gather(const struct solve *s, const struct balance *x, uint32_t e)
{
    const struct refinement *r = &s->refinement;
    size_t i;
    double h[3] = { 0, 0, 0 };
    uint32_t b = x->bands, k;
    for (i = r->first_link[e]; i < r->first_link[e + 1]; i++) {
        const struct link *l = &r->links[i];
        double weight = (double)l->form_factor * (l->visibility * (1.0 / LINK_VISIBLE));
        const double *from = &x->value[(size_t)l->emitter * b];
        for (k = 0; k < b; k++)
            h[k] += weight * from[k];
    }
    cluster_light_gather(&s->cluster_light, (int)b, e, h);
    for (k = 0; k < b; k++)
        x->irradiance[(size_t)e * b + k] = h[k];
}

static void gather_below(const struct solve *s, const struct balance *x, uint32_t e)
{
    const struct element *at = &s->hierarchy.elements[e];
    int c;
    gather(s, x, e);
    for (c = 0; c < at->children; c++)
        gather_below(s, x, at->child + (uint32_t)c);
}

/* Push irradiance down to the leaves and scale it there. spare[band] gathers the power (over the face) that row_gift
 * gives out again: under closure a blind leaf's share of the mean, else what the cap takes away. */
static void push(const struct solve *s, const struct balance *x, uint32_t e, const double above[3], double spare[3])
{
    const struct element *at = &s->hierarchy.elements[e];
    uint32_t b = x->bands, k;
    double *H = &x->irradiance[(size_t)e * b], h[3];
    int c;
    for (k = 0; k < b; k++)
        h[k] = above[k] + H[k];
    for (c = 0; c < at->children; c++)
        push(s, x, at->child + (uint32_t)c, h, spare);
    for (k = 0; k < b && !at->children; k++) {
        H[k] = above[k] * s->row_above[e] + H[k] * s->row_scale[e];
        spare[k] += at->area * (s->options.closure == CLOSURE_ROWS ? H[k] : h[k] - H[k]);
    }
}

/* x = source + rho H at the leaves, means above. Returns sum A |dx| over the leaves. */
static double pull(const struct solve *s, const struct balance *x, uint32_t e, const double spare[3])
{
    const struct element *at = &s->hierarchy.elements[e];
    uint32_t b = x->bands, k;
    double *X = &x->value[(size_t)e * b], *H = &x->irradiance[(size_t)e * b], moved = 0;
    int c;
    if (!at->children) {
        const double *source = &x->source[(x->by_element ? (size_t)e : (size_t)at->face) * b];
        const double *rho = &x->reflectance[(size_t)at->face * b];
        for (k = 0; k < b; k++) {
            double exposed = s->exposed[e], gift = spare[k] * s->row_gift[e], next;
            H[k] += exposed > 0 ? gift : 0;
            next = source[k] + rho[k] * (exposed > 0 ? H[k] / exposed : gift);
            moved += at->area * exposed * fabs(next - X[k]);
            X[k] = next;
        }
        return moved;
    }
    for (k = 0; k < b; k++)
        X[k] = H[k] = 0;
    for (c = 0; c < at->children; c++) {
        uint32_t j = at->child + (uint32_t)c;
        double sent = balance_share(s, j, e), received = s->hierarchy.elements[j].area / at->area;
        moved += pull(s, x, j, spare);
        for (k = 0; k < b; k++) {
            X[k] += sent * x->value[(size_t)j * b + k];
            H[k] += received * x->irradiance[(size_t)j * b + k];
        }
    }
    return moved;
}

/* One sweep over all faces. moved[face] receives sum A |dx|. */
static void sweep(const struct solve *s, const struct balance *x, double *moved)
{
    static const double nothing[3] = { 0, 0, 0 };
    uint32_t faces = s->scene->face_count, blocks = s->options.jacobi ? 1 : faces < BLOCKS ? faces : BLOCKS, block;
    cluster_light_send(&s->cluster_light, (int)x->bands, x->value);
#pragma omp parallel num_threads(s->options.threads) private(block) if (s->refinement.link_count > LINKS_WORTH_THREADS)
    for (block = 0; block < blocks; block++) {
        uint32_t from = (uint32_t)((uint64_t)faces * block / blocks), to = (uint32_t)((uint64_t)faces * (block + 1) / blocks), i;
#pragma omp for schedule(dynamic, 8)
        for (i = from; i < to; i++)
            gather_below(s, x, s->hierarchy.face_element[i]);
#pragma omp for schedule(dynamic, 64)
        for (i = from; i < to; i++) {
            double spare[3] = { 0, 0, 0 };
            push(s, x, s->hierarchy.face_element[i], nothing, spare);
            moved[i] = pull(s, x, s->hierarchy.face_element[i], spare);
        }
    }
}

int balance_solve(struct solve *s, struct balance *x)
{
    uint32_t faces = s->scene->face_count, i, k;
    double *moved = malloc(faces * sizeof *moved), rho = 0;
    if (!moved)
        return -1;
    for (i = 0; i < faces * x->bands; i++)
        rho = x->reflectance[i] > rho ? x->reflectance[i] : rho;
    x->converged = 0;
    for (x->sweeps = 0; x->sweeps < s->options.iterations && !x->converged;) {
        double change = 0, power = 0;
        sweep(s, x, moved);
        x->sweeps++;
        s->sweeps++;
        for (i = 0; i < faces; i++) {
            uint32_t e = s->hierarchy.face_element[i];
            change += moved[i];
            for (k = 0; k < x->bands; k++)
                power += s->hierarchy.elements[e].area * s->exposed[e] * x->value[(size_t)e * x->bands + k];
        }
        s->residual = x->residual = power > 0 ? change / power : 0;
        x->converged = x->residual * rho <= x->tolerance * (1 - rho);
        if (s->options.progress && s->options.progress(s->options.context, s, "solve") != 0) {
            s->cancelled = 1;
            break;
        }
    }
    free(moved);
    return s->cancelled ? -1 : 0;
}
