/* push_pull.c - light on one face and its parts: gather over links, push down, pull up.
 *
 * A solid may stand on part of a surface, like a table leg on the floor. What it covers receives
 * nothing and sends nothing; rays know that, but a mean over the whole element would send the
 * missing light a second time less. So x is the mean over the uncovered part, and x = source + rho
 * H / uncovered, where H stays the mean over all; of two parts the barer one is handed more. (A
 * leaf found wholly covered has no weight in its parent, but may yet be linked by rays that did
 * find it: closure gives it the irradiance of its face too.)
 *
 * All of it is linear in value, irradiance and source together: with a source of 0 it carries
 * changes as it carries light.
 * [Hanrahan et al. 1991, sections 4 and 5]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include "engine/push_pull.h"

void element_gather(const struct light_operator *op, const double *value, uint32_t bands,
                    uint32_t e, double h[3])
{
    const struct refinement *r = op->refinement;
    h[0] = h[1] = h[2] = 0;
    for (size_t i = r->first_link[e]; i < r->first_link[e + 1]; i++) {
        double weight = operator_weight(op, i);
        const double *from = &value[(size_t)r->links[i].emitter * bands];
        for (uint32_t k = 0; k < bands; k++)
            h[k] += weight * from[k];
    }
    separable_links_gather(&op->separable, (int)bands, e, h);
}

void face_gather(const struct light_operator *op, const struct transport *x, uint32_t e)
{
    const struct element *at = &op->hierarchy->elements[e];
    double h[3];
    element_gather(op, x->value, x->bands, e, h);
    for (uint32_t k = 0; k < x->bands; k++)
        x->irradiance[(size_t)e * x->bands + k] = h[k];
    for (int c = 0; c < at->children; c++)
        face_gather(op, x, at->child + (uint32_t)c);
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
    for (uint32_t j = at->child; j < at->child + at->children; j++) {
        double bare = operator_bare(op, j, e), on_child[3];
        for (uint32_t k = 0; k < b; k++)
            on_child[k] = bare * h[k];
        push(op, x, j, on_child, spare);
    }
    for (uint32_t k = 0; k < b && !at->children; k++) {
        H[k] = above[k] * op->row_above[e] + H[k] * op->row_scale[e];
        spare[k] += at->area * (op->problem->options.closure == CLOSURE_ROWS ? H[k] : h[k] - H[k]);
    }
}

void element_average(const struct light_operator *op, const struct transport *x, uint32_t e)
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
        element_average(op, x, e);
        return;
    }
    static const double none[3] = {0, 0, 0};
    const double *source =
        x->source ? &x->source[(x->by_element ? (size_t)e : (size_t)at->face) * b] : none;
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

void face_update(const struct light_operator *op, const struct transport *x, uint32_t e,
                 struct change *change)
{
    static const double nothing[3] = {0, 0, 0};
    double spare[3] = {0, 0, 0};
    push(op, x, e, nothing, spare);
    *change = (struct change){0};
    pull(op, x, e, spare, change);
    for (uint32_t k = 0; k < x->bands; k++)
        change->power[k] =
            op->hierarchy->elements[e].area * op->uncovered[e] * x->value[(size_t)e * x->bands + k];
}
