/* error_local.c - see error_account.h: what each leaf makes of error by itself, cause by cause.
 *
 * With B~ the solution, K the true operator and B = E + K B the truth, the error e = B~ - B obeys
 *     e = K e + r,   r(x) = B~(x) - E - (K B~)(x),
 * and r comes apart by cause. At a point x of leaf i, over its links l and its ancestors',
 *     solver           B~_i - E - rho H~_i
 *     row cap          rho (H~_i - sum F_l V_l B_l)
 *     form factor      rho sum dF_l V_l B_l
 *     visibility       rho sum F_l dV_l B_l
 *     discretization   rho sum (F_l B_l - F_l(x) B(y)) V_l,
 * H~ the irradiance that the operator makes, capped; dF by the level of the link, dV as of as many
 * independent rays, sqrt(V (1 - V) / N), 0 where a shaft was seen through. Both are taken as
 * independent from link to link, which adds squares. Discretization is taken at corners and centre
 * for its largest, at Gauss' points for its means (residual.c): signed sums first. A cap takes from
 * leaves what their ancestors' links bring too much, which is discretization's; so what is told of
 * all together is told of their sum, with its signs, point by point.
 * [Arvo, Torrance and Smits 1994, sections 5 and 6; Bekaert and Willems 1996, equation 11]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "engine/error_account.h"
#include "engine/push_pull.h"
#include "engine/residual.h"
#include "kernel/constants.h"
#include "kernel/polygon_factor.h"
#include "terms/visibility.h"
#include "util/thread_pool.h"

/* ---- what the cap and the solver left */

/* Leave at the leaves below e what they gather before the cap, in `left`, and after it, in `cap`,
 * both over their whole area. spare[band]: as in push_pull.c. */
static void gather_below(const struct error_account *a, uint32_t e, const double above[3],
                         double spare[3])
{
    const struct solve *s = a->solve;
    const struct light_operator *op = &s->operator;
    const struct element *x = &s->hierarchy.elements[e];
    double own[3], all[3] = {0, 0, 0};
    uint32_t bands = s->problem.bands;
    element_gather(op, s->state.radiosity, bands, e, own);
    for (uint32_t k = 0; k < bands; k++)
        all[k] = above[k] + own[k];
    for (uint32_t j = x->child; j < x->child + x->children; j++) {
        double bare = operator_bare(op, j, e), on_child[3];
        for (uint32_t k = 0; k < bands; k++)
            on_child[k] = bare * all[k];
        gather_below(a, j, on_child, spare);
    }
    for (uint32_t k = 0; k < bands && !x->children; k++) {
        size_t at = (size_t)e * bands + k;
        a->left[at] = all[k];
        a->cap[at] = above[k] * op->row_above[e] + own[k] * op->row_scale[e];
        spare[k] +=
            x->area
            * (s->problem.options.closure == CLOSURE_ROWS ? a->cap[at] : all[k] - a->cap[at]);
    }
}

/* Turn both into what they leave of r. */
static void leave_below(const struct error_account *a, uint32_t e, const double spare[3])
{
    const struct solve *s = a->solve;
    const struct problem *p = &s->problem;
    const struct element *x = &s->hierarchy.elements[e];
    double uncovered = s->operator.uncovered[e];
    for (int c = 0; c < x->children; c++)
        leave_below(a, x->child + (uint32_t)c, spare);
    for (uint32_t k = 0; k < p->bands && !x->children; k++) {
        size_t at = (size_t)e * p->bands + k, face = (size_t)x->face * p->bands + k;
        double raw = a->left[at], capped = a->cap[at] + spare[k] * s->operator.row_share[e];
        a->left[at] = a->cap[at] = 0;
        if (!(uncovered > 0))
            continue;
        a->cap[at] = p->reflectance[face] * (capped - raw) / uncovered;
        a->left[at] =
            s->state.radiosity[at] - p->exitance[face] - p->reflectance[face] * capped / uncovered;
    }
}

static void account_faces(const void *account, size_t from, size_t to)
{
    static const double nothing[3] = {0, 0, 0};
    const struct error_account *a = account;
    for (size_t i = from; i < to; i++) {
        uint32_t e = a->solve->hierarchy.face_element[i];
        double spare[3] = {0, 0, 0};
        gather_below(a, e, nothing, spare);
        leave_below(a, e, spare);
    }
}

void error_local_signed(const struct error_account *a)
{
    const struct solve *s = a->solve;
    thread_pool_run(s->problem.options.threads, s->hierarchy.face_count, 8, account_faces, a);
}

/* ---- form factors and visibilities */

/* What F of a link is off by, likely and at the most. */
static void factor_error(const struct error_account *a, const struct link *l, double error[2])
{
    const struct element *elements = a->solve->hierarchy.elements;
    double f = (double)l->form_factor;
    switch (l->levels & 15) {
    case FORM_FACTOR_POLYGON:
        error[0] = FORM_FACTOR_POLYGON_TYPICAL * f;
        error[1] = FORM_FACTOR_POLYGON_MOST * f;
        break;
    case FORM_FACTOR_CONTOUR:
        error[0] = error[1] = FORM_FACTOR_CONTOUR_MOST;
        break;
    default: /* nothing is promised, so it is found out */
        error[0] = error[1] =
            fabs(f - polygon_factor(&elements[l->receiver], &elements[l->emitter], 1));
        break;
    }
}

/* Standard deviation of a link's V. */
static double visibility_error(const struct link *l)
{
    enum visibility_level level = (enum visibility_level)(l->levels >> 4);
    double v = l->visibility * (1.0 / LINK_VISIBLE);
    return level == VISIBILITY_EXACT ? 0 : sqrt(v * (1 - v) / visibility_rays_of(level));
}

/* Errors of one leaf's irradiance per band (W/m2): squares that are likely, and the most. */
struct leaf_errors {
    double factor[3], most[3], visibility[3];
};

static void add_link(const struct error_account *a, const struct link *l, double bare,
                     struct leaf_errors *e)
{
    uint32_t bands = a->solve->problem.bands;
    double v = bare * l->visibility * (1.0 / LINK_VISIBLE), off[2],
           noise = bare * visibility_error(l);
    factor_error(a, l, off);
    for (uint32_t k = 0; k < bands; k++) {
        double b = a->solve->state.radiosity[(size_t)l->emitter * bands + k],
               light = b * (double)l->form_factor * noise;
        e->factor[k] += b * v * off[0] * b * v * off[0];
        e->most[k] += b * v * off[1];
        e->visibility[k] += light * light;
    }
}

/* Of the separable links the noise of their rays. */
static void add_separable(const struct error_account *a, const struct link *l, size_t b,
                          double bare, const struct element *taker, struct leaf_errors *e)
{
    const struct separable_links *s = &a->solve->operator.separable;
    uint32_t bands = a->solve->problem.bands;
    double v = l->visibility * (1.0 / LINK_VISIBLE),
           noise = v > 0 ? bare * visibility_error(l) / v
                               * separable_links_at(s, &s->links[b], taker->centre, taker->normal)
                         : 0;
    for (uint32_t k = 0; k < bands; k++) {
        double light = (double)s->arrives[b * bands + k] * noise;
        e->visibility[k] += light * light;
    }
}

static void find_leaf_errors(const struct error_account *a, uint32_t leaf, struct leaf_errors *e)
{
    const struct solve *s = a->solve;
    const struct separable_links *c = &s->operator.separable;
    const struct element *elements = s->hierarchy.elements, *taker = &elements[leaf];
    double bare = 1;
    memset(e, 0, sizeof *e);
    for (uint32_t up = leaf;; up = elements[up].parent) {
        size_t b = c->count && up < c->elements ? c->first[up] : 0;
        if (elements[up].vertices) {
            taker = &elements[up];
            bare = operator_bare(&s->operator, leaf, up);
        }
        for (size_t i = s->refinement.first_link[up]; i < s->refinement.first_link[up + 1]; i++) {
            const struct link *l = &s->refinement.links[i];
            if (elements[l->receiver].vertices && elements[l->emitter].vertices)
                add_link(a, l, bare, e);
            else if (c->count && up < c->elements)
                add_separable(a, l, b++, bare, taker, e);
        }
        if (up == 0)
            break;
    }
}

/* ---- discretization */

/* Gauss' points of a leaf behind its corners and centre: four of a quad, three of a triangle. */
static int gauss_points(const struct element *e, double (*x)[3])
{
    const double inset = 0.21132486540518711775; /* (1 - 1 / sqrt 3) / 2 */
    for (int i = 0; i < e->vertices; i++)
        for (int k = 0; k < 3; k++) {
            if (e->vertices == 3) {
                x[i][k] = e->centre[k] + 0.5 * (e->vertex[i][k] - e->centre[k]);
                continue;
            }
            double s = i == 1 || i == 2 ? 1 - inset : inset, t = i >= 2 ? 1 - inset : inset;
            x[i][k] = (1 - s) * (1 - t) * e->vertex[0][k] + s * (1 - t) * e->vertex[1][k]
                      + s * t * e->vertex[2][k] + (1 - s) * t * e->vertex[3][k];
        }
    return e->vertices;
}

/* Adds to the norms of one leaf what constants cost there, and what is left of that with what cap
 * and solver have done: the cap mends much of it. */
static void find_discretization(const struct error_account *a, uint32_t leaf, struct norm_sums *n,
                                struct norm_sums *mended)
{
    const struct solve *s = a->solve;
    const struct problem *p = &s->problem;
    const struct element *e = &s->hierarchy.elements[leaf];
    struct residual_points at = {.spread = a->spread,
                                 .detail = RANGE_DETAIL * rays_host(p->rays)->irradiance};
    residual_corners(e, &at);
    int first = at.count;
    at.count += gauss_points(e, &at.at[first]);
    (void)residual_at_points(&s->operator, s->state.radiosity, leaf, &at);
    double area = e->area * s->operator.uncovered[leaf] /(at.count - first);
    for (int i = 0; i < at.count; i++)
        for (uint32_t k = 0; k < p->bands; k++) {
            size_t band = (size_t)leaf * p->bands + k;
            double error = -p->reflectance[(size_t)e->face * p->bands + k]
                           * (at.sum[0][i][k] + at.sum[1][i][k]) / s->operator.uncovered[leaf];
            norm_add(n, i < first ? 0 : area, error);
            norm_add(mended, i < first ? 0 : area, error + a->cap[band] + a->left[band]);
        }
}

/* ---- all leaves */

enum { LEAF_CATEGORIES = 4 };

struct leaf_account {
    const struct error_account *account;
    struct norm_sums (*leaf)[LEAF_CATEGORIES]; /* [element] */
};

static void account_leaves(const void *leaves, size_t from, size_t to)
{
    const struct leaf_account *l = leaves;
    const struct error_account *a = l->account;
    const struct solve *s = a->solve;
    const struct problem *p = &s->problem;
    for (uint32_t i = (uint32_t)from; i < to; i++) {
        struct norm_sums *leaf = l->leaf[i];
        struct leaf_errors e;
        if (!account_counts(a, i))
            continue;
        find_discretization(a, i, &leaf[0], &leaf[3]);
        find_leaf_errors(a, i, &e);
        for (uint32_t k = 0; k < p->bands; k++) {
            double uncovered = s->operator.uncovered[i],
                   area = s->hierarchy.elements[i].area * uncovered,
                   rho = p->reflectance[(size_t)s->hierarchy.elements[i].face * p->bands + k]
                         / uncovered;
            norm_add(&leaf[1], area, rho * sqrt(e.factor[k]));
            norm_add(&leaf[2], area, rho * sqrt(e.visibility[k]));
            a->factor[(size_t)i * p->bands + k] = rho * e.most[k];
        }
    }
}

int error_local_make(const struct error_account *a)
{
    const struct solve *s = a->solve;
    const struct problem *p = &s->problem;
    static const enum RadErrorCategory of[LEAF_CATEGORIES] = {
        RAD_CATEGORY_DISCRETIZATION, RAD_CATEGORY_FORM_FACTOR, RAD_CATEGORY_VISIBILITY,
        RAD_CATEGORY_TOGETHER};
    struct norm_sums(*leaf)[LEAF_CATEGORIES] = calloc(s->hierarchy.count, sizeof *leaf),
           all[LEAF_CATEGORIES] = {{0, 0, 0}};
    if (!leaf)
        return -1;
    const struct leaf_account leaves = {a, leaf};
    thread_pool_run(p->options.threads, s->hierarchy.count, 16, account_leaves, &leaves);
    for (uint32_t i = 0; i < s->hierarchy.count; i++)
        for (int c = 0; c < LEAF_CATEGORIES; c++) {
            all[c].first += leaf[i][c].first;
            all[c].second += leaf[i][c].second;
            all[c].most = fmax(all[c].most, leaf[i][c].most);
        }
    for (int c = 0; c < LEAF_CATEGORIES; c++)
        a->report->estimate[of[c]] = norms_of(&all[c]);
    free(leaf);
    return 0;
}
