/* residual.c - what constants cost: the discretization residual of a leaf.
 *
 * d = rho max_k |sum_l B_s V (F(x_k) - F)| over the leaf's own links l and its ancestors', x_k the
 * leaf's corners and its centre: the irradiance that the links would bring to the point, less what
 * they bring to the whole leaf. Errors of opposite sign cancel as they do in truth, so the sum is
 * taken first and the modulus then.
 * [Bekaert and Willems 1996, equation 11; Arvo et al. 1994, section 5.2: what projection onto
 * constants leaves]
 *
 * Between the points F may range further; and V is the link's, so a shadow's edge that crosses the
 * leaf does not show. Exitance is the same all over a face and adds nothing. Corners are taken
 * CORNER_INSET of the way to the centre.
 *
 * Where a link has a cluster at one end, the emitter is the pivot that the link takes it for
 * (separable_links.h), and what its whole face takes is what the leaf does. The receiver's clusters
 * count, too.
 *
 * The account of error asks at points of its own, and takes emitters by their leaves where their
 * radiosities differ: then what the mean over an emitter costs is in the sum, too.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>
#include "engine/residual.h"
#include "kernel/point_factor.h"
#include "kernel/surface_point.h"

/* Add what the emitter would bring to each point through visibility `visible`: as one, or, where
 * its leaves differ enough to matter, part by part. */
static void add_emitter(struct residual_points *p, const struct light_operator *op,
                        const double *radiosity, uint32_t emitter, double visible,
                        const struct element *leaf, double (*sum)[3])
{
    uint32_t bands = op->problem->bands;
    const struct element *e = &op->hierarchy->elements[emitter];
    double factor[RESIDUAL_POINTS], most = 0;
    _Static_assert((int)RESIDUAL_POINTS <= (int)LAMBERT_POINTS, "as many as run at once");
    struct polygon q;
    point_factor_clip(&q, leaf, e);
    point_factors_at(p->count, (const double(*)[3])p->at, leaf, e, &q, factor);
    for (int i = 0; i < p->count; i++) {
        factor[i] *= visible;
        most = fmax(most, factor[i]);
    }
    if (p->spread && e->children && most * p->spread[emitter] > p->detail) {
        for (int c = 0; c < e->children; c++)
            add_emitter(p, op, radiosity, e->child + (uint32_t)c, visible, leaf, sum);
        return;
    }
    for (int i = 0; i < p->count; i++)
        for (uint32_t k = 0; k < bands; k++)
            sum[i][k] += radiosity[(size_t)emitter * bands + k] * factor[i];
}

/* `bare`: what of the link falls on the leaf (operator_bare). */
static void add_link(struct residual_points *p, const struct light_operator *op,
                     const double *radiosity, size_t link, double bare, const struct element *leaf)
{
    const struct link *l = &op->refinement->links[link];
    uint32_t bands = op->problem->bands;
    double visible = bare * l->visibility * (1.0 / LINK_VISIBLE),
           (*sum)[3] = p->sum[l->mark == LINK_GUARDED];
    add_emitter(p, op, radiosity, l->emitter, visible, leaf, sum);
    for (int i = 0; i < p->count; i++)
        for (uint32_t k = 0; k < bands; k++)
            sum[i][k] -=
                radiosity[(size_t)l->emitter * bands + k] * visible * operator_factor(op, link);
}

/* The same for the separable links of element `up`, which is the leaf or holds it, and of which
 * `taker` takes the light: the whole face, or the part of it that has the links. Returns how many
 * there are. */
static uint32_t add_separable(struct residual_points *p, const struct light_operator *op,
                              uint32_t up, double bare, const struct element *taker)
{
    const struct separable_links *s = &op->separable;
    uint32_t bands = op->problem->bands;
    if (s->count == 0 || up >= s->elements)
        return 0;
    for (size_t b = s->first[up]; b < s->first[up + 1]; b++) {
        double whole = separable_links_at(s, &s->links[b], taker->centre, taker->normal);
        for (int i = 0; i < p->count; i++) {
            double off =
                bare * (separable_links_at(s, &s->links[b], p->at[i], taker->normal) - whole);
            for (uint32_t k = 0; k < bands; k++)
                p->sum[0][i][k] += s->arrives[b * bands + k] * off;
        }
    }
    return (uint32_t)(s->first[up + 1] - s->first[up]);
}

/* rho times the largest modulus over points and bands. */
static double largest(const struct residual_points *p, const struct problem *problem,
                      const struct element *e, const double (*sum)[3])
{
    const double *rho = &problem->reflectance[(size_t)e->face * problem->bands];
    double most = 0;
    for (int i = 0; i < p->count; i++)
        for (uint32_t k = 0; k < problem->bands; k++)
            most = fmax(most, rho[k] * fabs(sum[i][k]));
    return most;
}

uint32_t residual_at_points(const struct light_operator *op, const double *radiosity, uint32_t leaf,
                            struct residual_points *p)
{
    const struct element *elements = op->hierarchy->elements, *e = &elements[leaf], *taker = e;
    const struct refinement *r = op->refinement;
    uint32_t links = 0;
    double bare = 1;
    memset(p->sum, 0, sizeof p->sum);
    for (uint32_t up = leaf;; up = elements[up].parent) {
        if (elements[up].vertices) {
            taker = &elements[up];
            bare = operator_bare(op, leaf, up);
        }
        links += add_separable(p, op, up, bare, taker);
        for (size_t l = r->first_link[up]; l < r->first_link[up + 1]; l++) {
            if (!elements[r->links[l].receiver].vertices || !elements[r->links[l].emitter].vertices)
                continue;
            add_link(p, op, radiosity, l, bare, e);
            links++;
        }
        if (up == 0)
            break;
    }
    return links;
}

void residual_corners(const struct element *e, struct residual_points *p)
{
    p->count = e->vertices + 1;
    for (int i = 0; i < e->vertices; i++)
        surface_corner(p->at[i], e, i);
    memcpy(p->at[e->vertices], e->centre, sizeof e->centre);
}

struct leaf_residual residual_of_leaf(const struct light_operator *op, const double *radiosity,
                                      uint32_t leaf)
{
    const struct element *e = &op->hierarchy->elements[leaf];
    struct leaf_residual result;
    struct residual_points p = {.spread = NULL};
    residual_corners(e, &p);
    result.links = residual_at_points(op, radiosity, leaf, &p);
    result.guarded = largest(&p, op->problem, e, (const double(*)[3])p.sum[1]);
    for (int i = 0; i < p.count; i++)
        for (int c = 0; c < 3; c++)
            p.sum[0][i][c] += p.sum[1][i][c];
    result.all = largest(&p, op->problem, e, (const double(*)[3])p.sum[0]);
    return result;
}
