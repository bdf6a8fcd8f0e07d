/* error_account.c - see error_account.h: the estimates put together, and the norms of the operator.
 *
 * What each leaf makes of error by itself is found in error_local.c. Of that, discretization leaves
 * no mean over the leaf, and errors of form factors and rays have no sign in common: gathered again
 * they cancel, and their estimates are not transported. Cap and solver may have one sign
 * everywhere, and are transported by the operator as they are; so is what an error of E and rho
 * would make, dE + drho H~. [Arvo, Torrance and Smits 1994, sections 5 and 6]
 *
 * All of it is derived for constants. Where the solution has slopes the account is that of what its
 * links would say without them, which is solved for once more, and says so.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "engine/error_account.h"
#include "engine/transport.h"
#include "kernel/constants.h"

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

/* What is left of each leaf is not what becomes of it: in a furnace light that one link brings too
 * much another brings too little. Where that is proved it is not told as likely. */
static void keep_to_bound(struct RadAccountReport *r)
{
    struct RadErrorNorms *likely = &r->estimate[RAD_CATEGORY_TOGETHER];
    const struct RadErrorNorms *most = &r->bound[RAD_CATEGORY_TOGETHER];
    likely->l1 = fmin(likely->l1, most->l1);
    likely->l2 = fmin(likely->l2, most->l2);
    likely->linf = fmin(likely->linf, most->linf);
}

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

/* ---- constants in place of slopes */

/* What a solution with slopes is given back. */
struct slopes {
    struct state state;
    double *rows; /* row_scale, row_above, row_share and row, one after the other */
};

static void rows_of(const struct light_operator *op, double *rows[4])
{
    rows[0] = op->row_scale;
    rows[1] = op->row_above;
    rows[2] = op->row_share;
    rows[3] = op->row;
}

/* Keep in `k` what there is, to be given back in any case, and leave copies of the radiosities. */
static int keep_slopes(struct solve *s, struct slopes *k)
{
    size_t count = s->hierarchy.count, values = count * s->problem.bands;
    double *rows[4];
    *k = (struct slopes){s->state, malloc(4 * count * sizeof *k->rows)};
    s->state = (struct state){malloc(values * sizeof(double)), malloc(values * sizeof(double))};
    if (!k->rows || !s->state.radiosity || !s->state.irradiance) {
        free(k->rows);
        k->rows = NULL;
        return -1;
    }
    memcpy(s->state.radiosity, k->state.radiosity, values * sizeof(double));
    memcpy(s->state.irradiance, k->state.irradiance, values * sizeof(double));
    rows_of(&s->operator, rows);
    for (int i = 0; i < 4; i++)
        memcpy(&k->rows[(size_t)i * count], rows[i], count * sizeof(double));
    return 0;
}

static void give_back(struct solve *s, struct slopes *k)
{
    size_t count = s->hierarchy.count;
    double *rows[4];
    rows_of(&s->operator, rows);
    for (int i = 0; i < 4 && k->rows; i++)
        memcpy(rows[i], &k->rows[(size_t)i * count], count * sizeof(double));
    free(k->rows);
    free(s->state.radiosity);
    free(s->state.irradiance);
    s->state = k->state;
}

/* Constants that go with the operator, from what the state holds. */
static int solve_constants(struct solve *s)
{
    double tolerance = s->problem.options.tolerance;
    struct transport t = {.bands = s->problem.bands,
                          .value = s->state.radiosity,
                          .irradiance = s->state.irradiance,
                          .source = s->problem.exitance,
                          .reflectance = s->problem.reflectance,
                          .tolerance = tolerance > 0 ? tolerance : SOLVE_TOLERANCE};
    if (transport_solve(&s->operator, & t) < 0)
        return -1;
    transport_average(&s->operator, & t);
    return 0;
}

static int make(struct error_account *a)
{
    struct solve *s = a->solve;
    struct RadAccountReport *r = a->report;
    struct row_report rows = s->report.rows;
    size_t count = s->hierarchy.count, bands = s->problem.bands;
    a->cap = calloc((3 * bands + 2) * count, sizeof *a->cap);
    if (!a->cap)
        return -1;
    a->left = a->cap + bands * count;
    a->factor = a->left + bands * count;
    a->most = a->factor + bands * count;
    a->spread = a->most + count;
    int failed =
        solve_renew_operator(s, &rows) < 0 || (s->linear.gradient && solve_constants(s) < 0);
    if (!failed) {
        separable_links_send(&s->operator.separable, (int)bands, s->state.radiosity);
        find_spread(a);
        find_reflected(a, a->factor);
        find_kappa(a, a->left);
        error_local_signed(a);
        failed = error_local_make(a) < 0 || find_carried(a) < 0;
    }
    if (!failed) {
        add_up(r);
        r->defect_mean = rows.defect_mean;
        r->defect_most = rows.defect_most;
        r->blind_area = rows.blind_area;
        r->guarded = s->refinement.marked[LINK_GUARDED];
        failed = error_bounds_make(a) < 0;
        keep_to_bound(r);
    }
    free(a->cap);
    return failed ? -1 : 0;
}

int error_account_make(struct error_account *a)
{
    struct solve *s = a->solve;
    struct slopes slopes = {{NULL, NULL}, NULL};
    int result = 0, constants = s->linear.gradient != NULL;
    memset(a->report, 0, sizeof *a->report);
    a->report->without_slopes = constants;
    if (constants)
        result = keep_slopes(s, &slopes);
    if (result == 0)
        result = make(a);
    if (constants)
        give_back(s, &slopes);
    if (result == 0)
        separable_links_send(&s->operator.separable, (int)s->problem.bands, s->state.radiosity);
    return result;
}
