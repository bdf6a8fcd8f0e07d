/* account_summary.c - see account_summary.h. What is not known is told as such: a bound that there
 * is none of is a dash, never a number.
 * SPDX-License-Identifier: MIT */
#include "commands/account_summary.h"
#include <math.h>
#include <stdio.h>
#include "output/json_values.h"

/* By enum RadErrorCategory: what it is called, in JSON too, and how to have less of it. */
static const struct {
    const char *name, *key, *cure;
} categories[RAD_CATEGORIES] = {
    {"boundary data", "boundary",
     "better data for materials and lamps would help, finer links would not"},
    {"discretization", "discretization", "smaller thresholds (--set) make smaller elements"},
    {"form factors", "form_factor", "an oracle that computes form factors better would help"},
    {"visibility", "visibility", "more rays (--set rays=64), or smaller thresholds, would help"},
    {"row cap", "row_cap", "smaller elements beside edges need less capping"},
    {"solver", "solver", "a smaller --tolerance, or more --iterations, would help"},
    {"together", "together", ""}};

/* A number of nine columns. */
static void print_number(double x)
{
    if (isfinite(x))
        printf(" %8.3g", x);
    else
        printf(" %8s", "-");
}

static void print_norms(const struct RadErrorNorms *n, double whole)
{
    print_number(n->l1);
    if (isfinite(n->l1) && whole > 0)
        printf(" %6.3g %%", 100 * n->l1 / whole);
    else
        printf(" %6s  ", "-");
    print_number(n->l2);
    print_number(n->linf);
}

/* Which cause has the largest estimate of the power that is wrong. The cap, which mends more than
 * it breaks, only where mesh alone does not say as much. */
static int largest(const struct RadErrorNorms *norms)
{
    int most = RAD_CATEGORY_DISCRETIZATION;
    double all = norms[RAD_CATEGORY_TOGETHER].l1, is = fmin(norms[most].l1, all);
    for (int c = 0; c < RAD_CATEGORY_TOGETHER; c++)
        if (fmin(norms[c].l1, all) > is) {
            most = c;
            is = fmin(norms[c].l1, all);
        }
    return most;
}

void account_print(const struct RadAccountReport *r)
{
    int most = largest(r->estimate);
    printf("account   how far B by links alone%s may be off, by cause: W, as a share of the "
           "reflected light; root "
           "mean square, W/m2 m; worst point, W/m2\n"
           "          %-14s  likely                              at the most\n",
           r->without_slopes ? ", one value per element (slopes are left out)," : "", "");
    for (int c = 0; c < RAD_CATEGORIES; c++) {
        printf("          %-14s", categories[c].name);
        print_norms(&r->estimate[c], r->reflected.l1);
        printf("  ");
        print_norms(&r->bound[c], r->reflected.l1);
        printf("\n");
    }
    if (r->estimate[most].l1 > 0)
        printf("blame     %s: %s\n", categories[most].name, categories[most].cure);
    if (!r->bounded)
        printf(
            "bounds    none: more than %.2g ranges of light would have to be kept; fewer elements "
            "have fewer\n",
            (double)r->ranges);
    else
        printf("bounds    hold at every point; proved: of %.2g %% of the light that nothing is in "
               "its way, of %.3g %% of the area that it sees surfaces alone\n",
               100 * r->visible, 100 * r->closed);
    printf("operator  ||K|| %.4g by rows", r->kappa_inf);
    if (isfinite(r->kappa_1))
        printf(", %.4g by columns", r->kappa_1);
    printf(" (largest rho %.4g); ||1/(1-K)|| %.4g", r->reflectance, r->inverse_found);
    if (isfinite(r->inverse_bound))
        printf(", at the most %.4g", r->inverse_bound);
    printf("; rows off 1 by %.2g in the mean; %llu links kept whole by a guard\n", r->defect_mean,
           (unsigned long long)r->guarded);
}

static json_t *norms_json(const struct RadErrorNorms *n)
{
    return json_pack("{s:o, s:o, s:o}", "l1", json_finite(n->l1), "l2", json_finite(n->l2), "linf",
                     json_finite(n->linf));
}

json_t *account_json(const struct RadAccountReport *r)
{
    json_t *all = json_object();
    for (int c = 0; c < RAD_CATEGORIES; c++)
        json_object_set_new(all, categories[c].key,
                            json_pack("{s:o, s:o}", "estimate", norms_json(&r->estimate[c]),
                                      "bound", norms_json(&r->bound[c])));
    json_object_set_new(all, "reflected", norms_json(&r->reflected));
    json_object_set_new(all, "blame", json_string(categories[largest(r->estimate)].key));
    json_object_set_new(all, "operator",
                        json_pack("{s:f, s:o, s:f, s:o, s:o, s:f, s:f, s:f, s:I}", "norm_rows",
                                  r->kappa_inf, "norm_columns", json_finite(r->kappa_1),
                                  "largest_reflectance", r->reflectance, "inverse_bound",
                                  json_finite(r->inverse_bound), "inverse_found",
                                  json_finite(r->inverse_found), "row_defect_mean", r->defect_mean,
                                  "row_defect_largest", r->defect_most, "blind_area", r->blind_area,
                                  "guard_hits", (json_int_t)r->guarded));
    json_object_set_new(all, "slopes_left_out", json_boolean(r->without_slopes));
    json_object_set_new(all, "bounded", json_boolean(r->bounded));
    json_object_set_new(all, "ranges", json_integer((json_int_t)r->ranges));
    json_object_set_new(all, "proved_visible", json_real(r->visible));
    json_object_set_new(all, "proved_closed", json_real(r->closed));
    json_object_set_new(all, "seconds", json_real(r->seconds));
    return all;
}
