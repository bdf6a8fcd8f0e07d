/* check_study_arvo.c - `radiosity study arvo` against a table made by samples, and what projections
 * owe to each other.
 *
 * The table is of this project's notes on Arvo, Torrance and Smits 1994: midpoints of a grid of
 * 1920 x 1920. Its L1 and L2 are met to all printed digits with as many; exactly they are up to
 * .00004 more, since midpoints never stand at an element's rim (of a slope over m of them a
 * variance is 1 - 1/m^2 of the whole). Its Linf is not of the grid and met exactly, but for one:
 * Galerkin's at n = 3, printed there as .1711, is .2394565 - .0684102 = .171046, by closed forms.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "command.h"
#include "folder.h"
#include "study/arvo.h"
#include "study/closed_forms.h"
#include "suite.h"

enum { FINEST = 64, ROWS = 5 };

static const struct row {
    int n;
    const char *l1[3], *l2[2], *linf[3]; /* L2: best is Galerkin's */
} table[ROWS] = {
    {3, {"0.60947", "0.66953", "2.05075"}, {"0.19046", "0.60121"}, {"0.1157", "0.1710", "0.2314"}},
    {4, {"0.74195", "0.89163", "0.76210"}, {"0.24045", "0.25100"}, {"0.1188", "0.2042", "0.2186"}},
    {8, {"0.42157", "0.43702", "0.43598"}, {"0.14462", "0.14512"}, {"0.1093", "0.1382", "0.1348"}},
    {32, {"0.10567", "0.10591", "0.10598"}, {"0.03543", "0.03558"}, {"0.0437", "0.0457", "0.0446"}},
    {64, {"0.05297", "0.05300", "0.05301"}, {"0.01781", "0.01783"}, {"0.0223", "0.0227", "0.0228"}},
};

static struct arvo_errors told[FINEST + 1]; /* by the command */

static int run(const char *arguments)
{
    return shell("cd %s && $RADIOSITY study arvo %s > out 2> err", folder, arguments);
}

static FILE *opened(const char *name)
{
    FILE *f = fopen(in_folder(name), "r");
    ck_assert_msg(f != NULL, "no %s", name);
    return f;
}

static void same(const char *printed, double value, const char *what, int n)
{
    char text[32];
    snprintf(text, sizeof text, "%.*f", (int)strlen(printed) - 2, value);
    ck_assert_msg(strcmp(text, printed) == 0, "%s at n = %d: %.9f, not %s", what, n, value,
                  printed);
}

static void read_table(void)
{
    ck_assert_int_eq(run("--csv a.csv --chart a.svg"), 0);
    FILE *f = opened("a.csv");
    char line[1024];
    ck_assert_ptr_nonnull(fgets(line, sizeof line, f));
    ck_assert_str_eq(line, "n,elements,l1_best,l1_galerkin,l1_collocation,l1_twice_best,l1_of_f,"
                           "l2_best,l2_galerkin,l2_collocation,l2_twice_best,l2_of_f,"
                           "linf_best,linf_galerkin,linf_collocation,linf_twice_best,linf_of_f\n");
    for (int n = 1; n <= FINEST; n++) {
        ck_assert_ptr_nonnull(fgets(line, sizeof line, f));
        char *at = line;
        ck_assert_int_eq(strtol(at, &at, 10), n);
        ck_assert_int_eq(strtol(at + 1, &at, 10), n * n);
        for (int k = 0; k < ARVO_NORMS; k++) {
            for (int p = 0; p < ARVO_PROJECTIONS; p++)
                told[n].of[k][p] = strtod(at + 1, &at);
            ck_assert_double_eq_tol(strtod(at + 1, &at), 2 * told[n].of[k][ARVO_BEST], 2e-9);
            told[n].norm[k] = strtod(at + 1, &at);
        }
    }
    ck_assert_ptr_null(fgets(line, sizeof line, f));
    fclose(f);
}

START_TEST(all_printed_digits)
{
    for (int r = 0; r < ROWS; r++) {
        struct arvo_errors e;
        int n = table[r].n;
        ck_assert_int_eq(arvo_sample(&e, n, 1920), 0);
        for (int p = 0; p < ARVO_PROJECTIONS; p++) {
            same(table[r].l1[p], e.of[ARVO_L1][p], "L1 by samples", n);
            same(table[r].l2[p / 2], e.of[ARVO_L2][p], "L2 by samples", n);
            same(table[r].linf[p], told[n].of[ARVO_LINF][p], "Linf", n);
        }
        /* Exactly: the limit of finer samples, and a little above any. */
        struct arvo_errors half;
        ck_assert_int_eq(arvo_sample(&half, n, 960), 0);
        for (int p = 0; p < ARVO_PROJECTIONS; p++) {
            double limit = (4 * e.of[ARVO_L2][p] - half.of[ARVO_L2][p]) / 3;
            ck_assert_double_eq_tol(told[n].of[ARVO_L2][p], limit, 1e-6);
            double more = told[n].of[ARVO_L1][p] - e.of[ARVO_L1][p];
            ck_assert_double_ge(more, 0);
            ck_assert_double_le(more, 4e-5);
        }
    }
}
END_TEST

START_TEST(norms_of_the_light)
{
    const char *const want[ARVO_NORMS] = {"0.968003", "0.298244", "0.239456"};
    double middle = 4 * closed_corner(0.5, 0.5, 1);
    double far =
        closed_corner(5.5, 5.5, 1) - 2 * closed_corner(5.5, 4.5, 1) + closed_corner(4.5, 4.5, 1);
    for (int n = 1; n <= FINEST; n++)
        for (int k = 0; k < ARVO_NORMS; k++)
            same(want[k], told[n].norm[k], "a norm of f", n);
    ck_assert_double_eq_tol(told[1].of[ARVO_LINF][ARVO_BEST], 0.5 * (middle - far), 1e-9);
    /* What a square lamp of 1 m2 and 1 W/m2 sends to four quarters, by the catalog. */
    ck_assert_double_eq_tol(told[1].norm[ARVO_L1] / 100 + told[1].of[ARVO_LINF][ARVO_GALERKIN],
                            middle, 2e-9);
}
END_TEST

/* For every n. Galerkin's mean enlarges no function in any norm, so it stays below twice the best
 * [Arvo et al., section 5]; a value of f on the element does so in Linf alone. */
START_TEST(what_projections_owe)
{
    for (int n = 1; n <= FINEST; n++) {
        double(*of)[ARVO_PROJECTIONS] = told[n].of;
        ck_assert_double_eq_tol(of[ARVO_L2][ARVO_BEST], of[ARVO_L2][ARVO_GALERKIN], 2e-9);
        for (int k = 0; k < ARVO_NORMS; k++) {
            ck_assert_double_le(of[k][ARVO_BEST], of[k][ARVO_GALERKIN] + 2e-9);
            ck_assert_double_le(of[k][ARVO_BEST], of[k][ARVO_COLLOCATION] + 2e-9);
            ck_assert_double_le(of[k][ARVO_GALERKIN], 2 * of[k][ARVO_BEST] + 2e-9);
            if (2 * n <= FINEST) /* the finer constants can do what the coarser do */
                ck_assert_double_le(told[2 * n].of[k][ARVO_BEST], of[k][ARVO_BEST] + 2e-9);
        }
        /* A centre under the lamp takes its light for a large element's. */
        ck_assert_int_eq(of[ARVO_L1][ARVO_COLLOCATION] > 2 * of[ARVO_L1][ARVO_BEST],
                         n == 1 || n == 3);
        ck_assert_int_eq(of[ARVO_L2][ARVO_COLLOCATION] > 2 * of[ARVO_L2][ARVO_BEST],
                         n == 1 || n == 3 || n == 5);
        ck_assert_double_le(of[ARVO_LINF][ARVO_COLLOCATION], 2 * of[ARVO_LINF][ARVO_BEST] + 2e-9);
    }
}
END_TEST

START_TEST(what_is_shown)
{
    char text[256] = "", last[256] = "";
    FILE *f = opened("out");
    while (fgets(text, sizeof text, f))
        strcpy(last, text);
    fclose(f);
    ck_assert_str_eq(last, "* above twice the best: at n = 1 3 5\n");
    f = opened("err");
    ck_assert_ptr_null(fgets(text, sizeof text, f));
    fclose(f);
    f = opened("a.svg");
    int panels = 0;
    while (fgets(text, sizeof text, f))
        panels +=
            strstr(text, ">Linf, W/m2<") || strstr(text, ">L2, W/m<") || strstr(text, ">L1, W<");
    fclose(f);
    ck_assert_int_eq(panels, 3);
}
END_TEST

int main(void)
{
    if (folder_make("arvo") < 0)
        return 1;
    Suite *suite = suite_create("study arvo");
    TCase *c = tcase_create("arvo");
    tcase_set_timeout(c, 300);
    tcase_add_unchecked_fixture(c, read_table, NULL);
    tcase_add_test(c, all_printed_digits);
    tcase_add_test(c, norms_of_the_light);
    tcase_add_test(c, what_projections_owe);
    tcase_add_test(c, what_is_shown);
    suite_add_tcase(suite, c);
    int failed = suite_failures(suite);
    folder_remove();
    return failed != 0;
}
