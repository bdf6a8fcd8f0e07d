/* error_bounds.c - see error_account.h: the bounds, which hold for certain.
 *
 * The true B is between the least and the most that the leaves' ranges allow (light_bounds.c), so
 * |B~ - B| is no more than what B~ is from the farther of the two, at any point. That is the bound
 * of all causes but boundary data. The same with each link's V taken for right at all its points,
 * where nothing is known of it, is the bound of discretization; what the first has more than that,
 * leaf by leaf, is visibility's. Nothing in either is sampled, and neither needs links or their
 * form factors to be any good; so what form factors, cap and solver have done is within both. By
 * themselves they are bounded by the norm of the inverse of the true 1 - K, at most 1 / (1 - rho)
 * in each norm, since no point sees more than everything and exchange is reciprocal.
 *
 * When E and rho are off by dE and drho, (1 - K')(B' - B) = dE + drho H; so with H at its most
 * |B' - B| is at most what dE + drho H makes under rho + drho. There is no bound where that
 * reaches 1.
 * [Arvo, Torrance and Smits 1994, equations for ||M^-1||, sections 5.1 and 5.3; Lischinski, Smits
 * and Greenberg 1994]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "engine/error_account.h"
#include "engine/light_bounds.h"

/* Per element, of one band; and sums over bands. */
struct bound_work {
    double *source, *start, *light; /* E; B~; the most H */
    double *most, *least;
    double *all; /* |B~ - B| at the most */
    double *rho; /* [face] */
    struct norm_sums sum[RAD_CATEGORIES];
};

static int solve_bounds(struct light_ranges *ranges, const struct bound_work *w,
                        enum light_bounds_of of, double rho, double *x, double *light)
{
    const struct light_bounds b = {ranges, of, w->source, w->rho, rho, w->start, x, light};
    return light_bounds_solve(&b);
}

/* |B~ - B| at the most for B from `least` to `most`. */
static double farther(double solved, double least, double most)
{
    return fmax(fmax(most - solved, solved - least), 0);
}

/* Boundary data: what dE + drho H makes under rho + drho. */
static int bound_boundary(struct error_account *a, struct light_ranges *ranges,
                          struct bound_work *w, uint32_t band)
{
    const struct solve *s = a->solve;
    const struct problem *p = &s->problem;
    double off = a->options->reflectance_error, rho = 0;
    if (!(off > 0 || a->options->exitance_error > 0))
        return 0;
    for (uint32_t i = 0; i < s->hierarchy.count; i++)
        if (account_counts(a, i))
            w->source[i] =
                account_exitance_error(a, s->hierarchy.elements[i].face, band) + off * w->light[i];
    for (uint32_t i = 0; i < s->hierarchy.face_count; i++) {
        w->rho[i] = p->reflectance[(size_t)i * p->bands + band] + off;
        rho = fmax(rho, w->rho[i]);
    }
    if (!(rho < 1)) {
        w->sum[RAD_CATEGORY_BOUNDARY] = (struct norm_sums){INFINITY, INFINITY, INFINITY};
        return 0;
    }
    memcpy(w->start, w->source, s->hierarchy.count * sizeof *w->start);
    if (solve_bounds(ranges, w, LIGHT_MOST, rho, w->most, NULL) < 0)
        return -1;
    for (uint32_t i = 0; i < s->hierarchy.count; i++)
        if (account_counts(a, i))
            norm_add(&w->sum[RAD_CATEGORY_BOUNDARY], s->hierarchy.elements[i].area, w->most[i]);
    return 0;
}

static int bound_band(struct error_account *a, struct light_ranges *ranges, struct bound_work *w,
                      uint32_t band)
{
    const struct solve *s = a->solve;
    const struct problem *p = &s->problem;
    const struct element *elements = s->hierarchy.elements;
    double rho = 0;
    for (uint32_t i = 0; i < s->hierarchy.face_count; i++) {
        w->rho[i] = p->reflectance[(size_t)i * p->bands + band];
        rho = fmax(rho, w->rho[i]);
    }
    for (uint32_t i = 0; i < s->hierarchy.count; i++) {
        w->source[i] = p->exitance[(size_t)elements[i].face * p->bands + band];
        w->start[i] = s->state.radiosity[(size_t)i * p->bands + band];
    }
    if (solve_bounds(ranges, w, LIGHT_MOST, rho, w->most, w->light) < 0
        || solve_bounds(ranges, w, LIGHT_LEAST, rho, w->least, NULL) < 0)
        return -1;
    for (uint32_t i = 0; i < s->hierarchy.count; i++)
        w->all[i] = farther(w->start[i], w->least[i], w->most[i]);
    if (solve_bounds(ranges, w, LIGHT_MOST_LINKED, rho, w->most, NULL) < 0
        || solve_bounds(ranges, w, LIGHT_LEAST_LINKED, rho, w->least, NULL) < 0)
        return -1;
    for (uint32_t i = 0; i < s->hierarchy.count; i++) {
        double area = elements[i].area, mesh = farther(w->start[i], w->least[i], w->most[i]);
        if (!account_counts(a, i))
            continue;
        mesh = fmin(mesh, w->all[i]);
        norm_add(&w->sum[RAD_CATEGORY_TOGETHER], area, w->all[i]);
        norm_add(&w->sum[RAD_CATEGORY_DISCRETIZATION], area, mesh);
        norm_add(&w->sum[RAD_CATEGORY_VISIBILITY], area, w->all[i] - mesh);
    }
    return bound_boundary(a, ranges, w, band);
}

/* ---- the rest */

/* Norms of an error made at each leaf, times the norm of the inverse. */
static struct RadErrorNorms amplified(const struct error_account *a, const double *x)
{
    struct RadErrorNorms n = account_norms(a, x, 1);
    double by = 1 / (1 - a->report->reflectance);
    return (struct RadErrorNorms){n.l1 * by, n.l2 * by, n.linf * by};
}

/* How much of the ranges is proved: by what they carry, and by area. */
static void tell_proofs(const struct error_account *a, const struct light_ranges *ranges)
{
    const struct hierarchy *h = &a->solve->hierarchy;
    double seen = 0, all = 0, closed = 0, area = 0;
    for (uint32_t i = 0; i < h->count; i++) {
        const struct share_row *row = &ranges->rows[i];
        if (!account_counts(a, i))
            continue;
        closed += ranges->closed[i] ? h->elements[i].area : 0;
        area += h->elements[i].area;
        for (uint32_t k = 0; k < row->share_count; k++) {
            double carries =
                h->elements[i].area * (double)row->shares[k].high * a->most[row->shares[k].emitter];
            all += carries;
            seen += row->shares[k].visible ? carries : 0;
        }
    }
    a->report->visible = all > 0 ? seen / all : 0;
    a->report->closed = area > 0 ? closed / area : 0;
}

static int bound_all(struct error_account *a, struct light_ranges *ranges)
{
    const struct hierarchy *h = &a->solve->hierarchy;
    struct RadErrorNorms *bound = a->report->bound;
    struct bound_work w = {.source = calloc(6 * (size_t)h->count, sizeof(double)),
                           .rho = calloc(h->face_count, sizeof *w.rho)};
    int failed = !w.source || !w.rho;
    if (!failed) {
        double **const parts[] = {&w.source, &w.start, &w.light, &w.most, &w.least, &w.all};
        for (size_t i = 1; i < sizeof parts / sizeof *parts; i++)
            *parts[i] = w.source + i * h->count;
        for (uint32_t k = 0; k < a->solve->problem.bands && !failed; k++)
            failed = bound_band(a, ranges, &w, k) < 0;
    }
    free(w.source);
    free(w.rho);
    if (failed)
        return -1;
    for (int c = 0; c < RAD_CATEGORIES; c++)
        bound[c] = norms_of(&w.sum[c]);
    bound[RAD_CATEGORY_FORM_FACTOR] = amplified(a, a->factor);
    bound[RAD_CATEGORY_ROW_CAP] = amplified(a, a->cap);
    bound[RAD_CATEGORY_SOLVER] = amplified(a, a->left);
    bound[RAD_CATEGORY_TOGETHER].l1 += bound[RAD_CATEGORY_BOUNDARY].l1;
    bound[RAD_CATEGORY_TOGETHER].l2 += bound[RAD_CATEGORY_BOUNDARY].l2;
    bound[RAD_CATEGORY_TOGETHER].linf += bound[RAD_CATEGORY_BOUNDARY].linf;
    tell_proofs(a, ranges);
    a->report->bounded = 1;
    return 0;
}

int error_bounds_make(struct error_account *a)
{
    const struct solve *s = a->solve;
    struct light_ranges ranges;
    for (int c = 0; c < RAD_CATEGORIES; c++)
        a->report->bound[c] = (struct RadErrorNorms){INFINITY, INFINITY, INFINITY};
    if (a->options->estimates_only)
        return 0;
    if (light_ranges_open(&ranges, &s->operator, a->most, a->spread, a->watch, a->context) < 0)
        return -1;
    a->report->ranges = ranges.count;
    int failed = !ranges.too_many && bound_all(a, &ranges) < 0;
    light_ranges_close(&ranges);
    return failed ? -1 : 0;
}
