/* error_account.c - see error_account.h: the estimates, and the norms of the operator.
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
 *
 * Discretization leaves no mean over the leaf, and errors of form factors and rays have no sign in
 * common: gathered again they cancel, and their estimates are not transported. Cap and solver may
 * have one sign everywhere, and are transported by the operator as they are; so is what an error
 * of E and rho would make, dE + drho H~.
 * [Arvo, Torrance and Smits 1994, sections 5 and 6; Bekaert and Willems 1996, equation 11]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "engine/error_account.h"
#include "engine/residual.h"
#include "engine/transport.h"
#include "kernel/constants.h"
#include "kernel/polygon_factor.h"
#include "terms/visibility.h"

struct RadErrorNorms account_norms(const struct error_account *a, const double *x, int whole)
{
    const struct solve *s = a->solve;
    uint32_t bands = s->problem.bands;
    struct norm_sums n = {0, 0, 0};
    for (uint32_t i = 0; i < s->hierarchy.count; i++) {
        if (!account_counts(a, i))
            continue;
        double area = s->hierarchy.elements[i].area * (whole ? 1 : s->operator.uncovered[i]);
        for (uint32_t k = 0; k < bands; k++)
            norm_add(&n, area, x[(size_t)i * bands + k]);
    }
    return norms_of(&n);
}

/* ---- what the cap and the solver left */

static void gather(const struct error_account *a, uint32_t e, double h[3])
{
    const struct solve *s = a->solve;
    const struct refinement *r = &s->refinement;
    uint32_t bands = s->problem.bands;
    for (size_t i = r->first_link[e]; i < r->first_link[e + 1]; i++) {
        const struct link *l = &r->links[i];
        double weight = operator_weight(&s->operator, i);
        for (uint32_t k = 0; k < bands; k++)
            h[k] += weight * s->state.radiosity[(size_t)l->emitter * bands + k];
    }
    separable_links_gather(&s->operator.separable, (int)bands, e, h);
}

/* Leave at the leaves below e what they gather before the cap, in `left`, and after it, in `cap`,
 * both over their whole area. spare[band]: as in transport.c. */
static void gather_below(const struct error_account *a, uint32_t e, const double above[3],
                         double spare[3])
{
    const struct solve *s = a->solve;
    const struct light_operator *op = &s->operator;
    const struct element *x = &s->hierarchy.elements[e];
    double own[3] = {0, 0, 0}, all[3] = {0, 0, 0};
    uint32_t bands = s->problem.bands;
    gather(a, e, own);
    for (uint32_t k = 0; k < bands; k++)
        all[k] = above[k] + own[k];
    for (int c = 0; c < x->children; c++)
        gather_below(a, x->child + (uint32_t)c, all, spare);
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

static void find_cap_and_solver(const struct error_account *a)
{
    static const double nothing[3] = {0, 0, 0};
    const struct solve *s = a->solve;
#pragma omp parallel for schedule(dynamic, 8) num_threads(s->problem.options.threads)
    for (uint32_t i = 0; i < s->hierarchy.face_count; i++) {
        double spare[3] = {0, 0, 0};
        gather_below(a, s->hierarchy.face_element[i], nothing, spare);
        leave_below(a, s->hierarchy.face_element[i], spare);
    }
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

static void add_link(const struct error_account *a, const struct link *l, struct leaf_errors *e)
{
    uint32_t bands = a->solve->problem.bands;
    double v = l->visibility * (1.0 / LINK_VISIBLE), off[2], noise = visibility_error(l);
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
                          const struct element *taker, struct leaf_errors *e)
{
    const struct separable_links *s = &a->solve->operator.separable;
    uint32_t bands = a->solve->problem.bands;
    double v = l->visibility * (1.0 / LINK_VISIBLE),
           noise = v > 0 ? visibility_error(l) / v
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
    memset(e, 0, sizeof *e);
    for (uint32_t up = leaf;; up = elements[up].parent) {
        size_t b = c->count && up < c->elements ? c->first[up] : 0;
        if (elements[up].vertices)
            taker = &elements[up];
        for (size_t i = s->refinement.first_link[up]; i < s->refinement.first_link[up + 1]; i++) {
            const struct link *l = &s->refinement.links[i];
            if (elements[l->receiver].vertices && elements[l->emitter].vertices)
                add_link(a, l, e);
            else if (c->count && up < c->elements)
                add_separable(a, l, b++, taker, e);
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

/* The largest B below each element and the largest difference of two, each in the band where it is
 * so. */
static void find_spread(const struct error_account *a)
{
    const struct solve *s = a->solve;
    uint32_t bands = s->problem.bands;
    double *low = a->cap, *high = a->left;            /* which nobody needs yet */
    for (uint32_t e = s->hierarchy.count; e-- > 0;) { /* children follow their parents */
        const struct element *x = &s->hierarchy.elements[e];
        a->most[e] = a->spread[e] = 0;
        for (uint32_t k = 0; k < bands; k++) {
            size_t at = (size_t)e * bands + k;
            low[at] = x->children ? INFINITY : s->state.radiosity[at];
            high[at] = x->children ? 0 : s->state.radiosity[at];
            for (uint32_t c = x->child; c < x->child + x->children; c++) {
                low[at] = fmin(low[at], low[(size_t)c * bands + k]);
                high[at] = fmax(high[at], high[(size_t)c * bands + k]);
            }
            a->most[e] = fmax(a->most[e], high[at]);
            a->spread[e] = fmax(a->spread[e], high[at] - low[at]);
        }
    }
}

static int find_local(const struct error_account *a)
{
    const struct solve *s = a->solve;
    const struct problem *p = &s->problem;
    enum { LEAF_CATEGORIES = 4 };
    static const enum RadErrorCategory of[LEAF_CATEGORIES] = {
        RAD_CATEGORY_DISCRETIZATION, RAD_CATEGORY_FORM_FACTOR, RAD_CATEGORY_VISIBILITY,
        RAD_CATEGORY_TOGETHER};
    struct norm_sums(*leaf)[LEAF_CATEGORIES] = calloc(s->hierarchy.count, sizeof *leaf),
           all[LEAF_CATEGORIES] = {{0, 0, 0}};
    if (!leaf)
        return -1;
#pragma omp parallel for schedule(dynamic, 16) num_threads(p->options.threads)
    for (uint32_t i = 0; i < s->hierarchy.count; i++) {
        struct leaf_errors e;
        if (!account_counts(a, i))
            continue;
        find_discretization(a, i, &leaf[i][0], &leaf[i][3]);
        find_leaf_errors(a, i, &e);
        for (uint32_t k = 0; k < p->bands; k++) {
            double uncovered = s->operator.uncovered[i],
                   area = s->hierarchy.elements[i].area * uncovered,
                   rho = p->reflectance[(size_t)s->hierarchy.elements[i].face * p->bands + k]
                         / uncovered;
            norm_add(&leaf[i][1], area, rho * sqrt(e.factor[k]));
            norm_add(&leaf[i][2], area, rho * sqrt(e.visibility[k]));
            a->factor[(size_t)i * p->bands + k] = rho * e.most[k];
        }
    }
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

/* ---- by one more solve */

/* x = source + K x into value, sources of either sign, on [element * bands + band]. Returns 0 or
 * -1. */
static int carry(const struct error_account *a, const double *source, double *value)
{
    const struct solve *s = a->solve;
    size_t values = (size_t)s->hierarchy.count * s->problem.bands;
    double *part = calloc(3 * values, sizeof *part), *x = part ? part + values : NULL;
    int failed = !part;
    if (part)
        memset(value, 0, values * sizeof *value);
    for (int sign = 1; sign >= -1 && !failed; sign -= 2) {
        double any = 0;
        for (size_t i = 0; i < values; i++) {
            part[i] = fmax(sign * source[i], 0);
            any = fmax(any, part[i]);
            x[i] = 0;
        }
        if (!(any > 0))
            continue;
        struct transport t = {.bands = s->problem.bands,
                              .value = x,
                              .irradiance = x + values,
                              .source = part,
                              .reflectance = s->problem.reflectance,
                              .by_element = 1,
                              .tolerance = ACCOUNT_TOLERANCE,
                              .rough = 1};
        failed = transport_solve(&s->operator, & t) < 0;
        for (size_t i = 0; i < values; i++)
            value[i] += sign * x[i];
    }
    free(part);
    return failed ? -1 : 0;
}

static int find_carried(struct error_account *a)
{
    const struct solve *s = a->solve;
    const struct problem *p = &s->problem;
    size_t values = (size_t)s->hierarchy.count * p->bands;
    double *source = calloc(2 * values, sizeof *source), *x = source ? source + values : NULL;
    struct RadErrorNorms *estimate = a->report->estimate;
    int failed = !source;
    if (!failed)
        failed = carry(a, a->cap, x) < 0;
    if (!failed) {
        estimate[RAD_CATEGORY_ROW_CAP] = account_norms(a, x, 0);
        failed = carry(a, a->left, x) < 0;
    }
    if (!failed) {
        estimate[RAD_CATEGORY_SOLVER] = account_norms(a, x, 0);
        for (uint32_t i = 0; i < s->hierarchy.count; i++)
            for (uint32_t k = 0; k < p->bands && account_counts(a, i); k++) {
                size_t at = (size_t)i * p->bands + k;
                source[at] = account_exitance_error(a, s->hierarchy.elements[i].face, k)
                             + a->options->reflectance_error * s->state.irradiance[at]
                                   / s->operator.uncovered[i];
            }
        failed = carry(a, source, x) < 0;
    }
    if (!failed) {
        estimate[RAD_CATEGORY_BOUNDARY] = account_norms(a, x, 0);
        for (size_t i = 0; i < values; i++)
            source[i] = 1;
        failed = carry(a, source, x) < 0;
    }
    if (!failed)
        a->report->inverse_found = account_norms(a, x, 0).linf;
    free(source);
    return failed ? -1 : 0;
}

/* ---- norms of the operator */

static void find_kappa(struct error_account *a, double *column)
{
    const struct solve *s = a->solve;
    const struct light_operator *op = &s->operator;
    const struct problem *p = &s->problem;
    struct RadAccountReport *r = a->report;
    const struct element *elements = s->hierarchy.elements;
    for (uint32_t i = 0; i < s->hierarchy.count; i++) {
        const struct element *x = &elements[i];
        if (account_counts(a, i))
            r->kappa_inf = fmax(r->kappa_inf, p->whitest[x->face] * op->row[i]);
        column[i] = 0;
    }
    for (size_t i = 0; i < s->refinement.link_count; i++) {
        const struct link *l = &s->refinement.links[i];
        const struct element *to = &elements[l->receiver], *from = &elements[l->emitter];
        if (to->vertices && from->vertices)
            column[l->emitter] +=
                to->area * p->whitest[to->face] * operator_weight(&s->operator, i) / from->area;
    }
    for (uint32_t i = 0; i < s->hierarchy.count; i++) { /* down: parents come first */
        if (elements[i].vertices && elements[i].depth > 0)
            column[i] += column[elements[i].parent];
        if (account_counts(a, i))
            r->kappa_1 = fmax(r->kappa_1, column[i]);
    }
    if (op->separable.count > 0)
        r->kappa_1 = NAN;
    for (uint32_t i = 0; i < s->hierarchy.face_count; i++)
        r->reflectance = fmax(r->reflectance, p->whitest[i]);
    r->inverse_bound = r->kappa_inf < 1 ? 1 / (1 - r->kappa_inf) : INFINITY;
}

/* Together: what discretization, cap and solver leave, whose signs are known; with the others as if
 * they were independent. */
static void add_up(struct RadAccountReport *r)
{
    static const enum RadErrorCategory others[] = {RAD_CATEGORY_BOUNDARY, RAD_CATEGORY_FORM_FACTOR,
                                                   RAD_CATEGORY_VISIBILITY};
    struct RadErrorNorms *sum = &r->estimate[RAD_CATEGORY_TOGETHER];
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        const struct RadErrorNorms *e = &r->estimate[others[i]];
        *sum = (struct RadErrorNorms){hypot(sum->l1, e->l1), hypot(sum->l2, e->l2),
                                      hypot(sum->linf, e->linf)};
    }
}

static void find_reflected(struct error_account *a, double *x)
{
    const struct solve *s = a->solve;
    const struct problem *p = &s->problem;
    for (uint32_t i = 0; i < s->hierarchy.count; i++)
        for (uint32_t k = 0; k < p->bands; k++) {
            size_t at = (size_t)i * p->bands + k;
            x[at] = s->state.radiosity[at]
                    - p->exitance[(size_t)s->hierarchy.elements[i].face * p->bands + k];
        }
    a->report->reflected = account_norms(a, x, 0);
}

/* The operator as the links are now: the last pass may have changed them after the last solve. */
static int renew_operator(struct solve *s)
{
    struct light_operator *op = &s->operator;
    struct row_report rows;
    if (s->report.changing > 0) {
        separable_links_close(&op->separable);
        if (separable_links_open(&op->separable, &s->hierarchy, &s->refinement,
                                 (int)s->problem.bands, s->problem.options.threads,
                                 s->problem.options.projection == RAD_PROJECTION_COLLOCATION)
            < 0)
            return -1;
        row_sums_scale(op, &rows);
    }
    return 0;
}

int error_account_make(struct error_account *a)
{
    struct solve *s = a->solve;
    struct RadAccountReport *r = a->report;
    size_t count = s->hierarchy.count, bands = s->problem.bands;
    memset(r, 0, sizeof *r);
    a->cap = calloc((3 * bands + 2) * count, sizeof *a->cap);
    if (!a->cap)
        return -1;
    a->left = a->cap + bands * count;
    a->factor = a->left + bands * count;
    a->most = a->factor + bands * count;
    a->spread = a->most + count;
    int failed = renew_operator(s) < 0;
    if (!failed) {
        separable_links_send(&s->operator.separable, (int)bands, s->state.radiosity);
        find_spread(a);
        find_reflected(a, a->factor);
        find_kappa(a, a->left);
        find_cap_and_solver(a);
        failed = find_local(a) < 0 || find_carried(a) < 0;
        separable_links_send(&s->operator.separable, (int)bands, s->state.radiosity);
    }
    if (!failed) {
        add_up(r);
        r->defect_mean = s->report.rows.defect_mean;
        r->defect_most = s->report.rows.defect_most;
        r->blind_area = s->report.rows.blind_area;
        r->guarded = s->refinement.marked[LINK_GUARDED];
        failed = error_bounds_make(a) < 0;
    }
    free(a->cap);
    return failed ? -1 : 0;
}
