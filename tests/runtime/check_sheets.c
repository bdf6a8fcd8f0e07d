/* check_sheets.c - view factors of two walls across a row of sheets, as of a collimator or blinds.
 *
 * Sheets as high as the walls stand upright between them. So a ray passes unless it does not as
 * seen from above, and what a stripe of one wall exchanges with one of the other, d beside it, is
 * atan(1 / sqrt(c)) / (pi c^1.5), c = 1 + d^2, for walls 1 m high and 1 m apart. Of each stripe the
 * sheets hide stretches of the other wall; the rest is summed up.
 * Two sheets beside each other leave a joint between them.
 * [two integrals over heights of Lambert's kernel; derived here]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "kernel/hash.h"
#include "radiosity.h"
#include "runtime/make_polygons.h"
#include "study/closed_forms.h"
#include "suite.h"

static const double WIDE = 1.2; /* m */
enum { STEPS = 1200, MOST = 20, OTHERS = 20 };

static double stripes(double d)
{
    const double c = 1 + d * d;
    return atan(1 / sqrt(c)) / (3.14159265358979323846 * c * sqrt(c));
}

/* [i]: over all d up to i WIDE / STEPS */
static double summed[STEPS + 1];

static double up_to(double d)
{
    const double at = d / WIDE * STEPS;
    const int i = at < STEPS ? (int)at : STEPS - 1;
    return summed[i] + (at - i) * (summed[i + 1] - summed[i]);
}

/* What a stripe sees to its right, of sheets so far from it there, nearest first, from `near` of
 * the wall to 1 - near. */
static double seen_beside(const double *sheet, int count, double near, double end)
{
    double sum = 0, from = 0;
    for (int i = 0; i < count; i++) {
        const double hidden = fmin(sheet[i] / (1 - near), end);
        if (hidden > from)
            sum += up_to(hidden) - up_to(from);
        from = fmin(fmax(from, sheet[i] / near), end);
    }
    return sum + up_to(end) - up_to(from);
}

static double right_factor(const double *sheet, int count, double near)
{
    enum { STRIPES = 4000 };
    double sum = 0, beside[2][MOST];
    for (int i = 0; i < STEPS; i++) {
        const double d = WIDE * i / STEPS, h = WIDE / STEPS;
        summed[i + 1] = summed[i] + h / 6 * (stripes(d) + 4 * stripes(d + h / 2) + stripes(d + h));
    }
    for (int i = 0; i < STRIPES; i++) {
        const double x = WIDE * (i + 0.5) / STRIPES;
        int left = 0, right = 0;
        for (int k = 0; k < count; k++)
            if (sheet[k] > x)
                beside[1][right++] = sheet[k] - x;
        for (int k = count - 1; k >= 0; k--)
            if (sheet[k] <= x)
                beside[0][left++] = x - sheet[k];
        sum +=
            seen_beside(beside[0], left, near, x) + seen_beside(beside[1], right, near, WIDE - x);
    }
    return sum / STRIPES;
}

/* Sheets in cells of one width, one width apart from the ends, too, or anywhere. */
enum row { IN_CELLS, APART, ANYWHERE, ROWS };
static void place(double *sheet, int count, enum row row)
{
    for (int i = 0; i < count; i++)
        sheet[i] = row == IN_CELLS ? WIDE * (i + 0.5) / count
                   : row == APART  ? WIDE * (i + 1) / (count + 1)
                                   : WIDE * (i + hash_unit((uint64_t)(count + i))) / count;
}

static double computed(const double *sheet, int count, double near)
{
    static double f[FACES], area[FACES];
    const double low[3] = {0, 0, 0}, high[3] = {0, 1, 0}, along[3] = {WIDE, 0, 0},
                 up[3] = {0, 0, 1};
    clear();
    rectangle(low, up, along);
    rectangle(high, along, up);
    for (int i = 0; i < count; i++) {
        const double at[3] = {sheet[i], near, 0}, deep[3] = {0, 1 - 2 * near, 0};
        rectangle(at, deep, up);
        rectangle(at, up, deep);
    }
    for (int i = 0; i < OTHERS; i++) { /* far above, facing away: there are many polygons */
        const double at[3] = {0, 0, 5 + 0.1 * i}, u[3] = {0.1, 0, 0}, v[3] = {0, 0.1, 0};
        rectangle(at, u, v);
    }
    factors(1, 0, f, area);
    return f[1];
}

/* All within the tolerance in the mean, and each within three. */
START_TEST(test_row)
{
    static const int counts[] = {5, 8, 12, 16, 20};
    static const double near[] = {0.1, 0.25, 0.4};
    enum { COUNTS = sizeof counts / sizeof *counts, NEAR = sizeof near / sizeof *near };
    double sheet[MOST], sum = 0, most = 0, rows = 0;
    for (int i = 0; i < COUNTS * NEAR * ROWS; i += under_sanitizers() ? 4 : 1) {
        const int count = counts[i % COUNTS];
        const double by = near[i / COUNTS % NEAR];
        place(sheet, count, (enum row)(i / COUNTS / NEAR));
        const double off = fabs(computed(sheet, count, by) - right_factor(sheet, count, by));
        sum += off;
        most = fmax(most, off);
        rows++;
    }
    printf("rows of sheets: off by %.1e in the mean, %.1e at the most\n", sum / rows, most);
    ck_assert_double_lt(sum / rows, 3e-4);
    ck_assert_double_lt(most, 9e-4);
}
END_TEST

/* What a joint of `width` between two sheets lets through, midway between unit plates 4 m apart:
 * over its length x and the points p of the plate beyond, whose mirror images in x the other plate
 * has.
 */
static double through_joint(double width)
{
    enum { N = 80 };
    double sum = 0;
    for (int i = 0; i < N; i++) {
        const double x = (i + 0.5) / N, from = fmax(0, 2 * x - 1), to = fmin(1, 2 * x);
        for (int j = 0; j < N * N; j++) {
            const double p = from + (to - from) * (j % N + 0.5) / N - x,
                         q = (j / N + 0.5) / N - 0.5, square = p * p + q * q + 4;
            sum += (to - from) * 4 / (square * square);
        }
    }
    return width * sum / (3.14159265358979323846 * N * N * N);
}

/* A joint that is narrower than edges of one place are apart counts as shut; a wider one lets
 * through what it does. None lets through what there is without sheets, which a ray from middle to
 * middle saw. */
START_TEST(test_joint)
{
    static const double width[] = {0,    1e-6,   1e-5, 2e-5, 3e-5, 3.5e-5,
                                   4e-5, 4.5e-5, 5e-5, 1e-4, 1e-3};
    static double f[FACES], area[FACES];
    const double right[3] = {1, 0, 0}, up[3] = {0, 1, 0}, wide[3] = {3, 0, 0};
    for (size_t i = 0; i < sizeof width / sizeof *width; i++) {
        const double half[3] = {0, 1.5 - width[i] / 2, 0}, lower[3] = {-1, -1, 2},
                     upper[3] = {-1, 0.5 + width[i] / 2, 2}, low[3] = {0, 0, 0},
                     high[3] = {0, 0, 4};
        clear();
        rectangle(low, right, up);
        rectangle(high, up, right);
        for (int side = 0; side < 2; side++) {
            rectangle(lower, side ? half : wide, side ? wide : half);
            rectangle(upper, side ? half : wide, side ? wide : half);
        }
        factors(1, 0, f, area);
        ck_assert_msg(f[1] < 1.01 * through_joint(width[i]) + 3e-8, "%g: %g", width[i], f[1]);
        if (width[i] > 9e-5)
            ck_assert_double_eq_tol(f[1], through_joint(width[i]), 0.01 * through_joint(width[i]));
    }
}
END_TEST

/* A wall with a canopy at half its height, seen across a hall: the middle of a wall lies in the
 * canopy's plane, and sees it from the edge, as points beside that do not. Where it is a thousandth
 * higher the factor is the same. */
START_TEST(test_canopy)
{
    static const double walls[9][3][3] = {
        {{0, 0, 20}, {0, 60, 0}, {100, 0, 0}},  {{0, 0, 0}, {0, 60, 0}, {0, 0, 20}},
        {{100, 0, 0}, {0, 0, 20}, {0, 60, 0}},  {{0, 0, 0}, {0, 0, 20}, {100, 0, 0}},
        {{0, 60, 0}, {100, 0, 0}, {0, 0, 20}},  {{30.2, 20.1, 1e-3}, {1e-3, 0, 0}, {0, 1e-3, 0}},
        {{28, 18, 4}, {2.19, 0, 0}, {0, 7, 0}}, {{28, 18, 0}, {0, 0, 4}, {0, 7, 0}},
        {{30.19, 18, 0}, {0, 7, 0}, {0, 0, 4}}};
    static double f[2][11 * 11], area[FACES];
    const double along[3] = {3, 0, 0}, across[3] = {0, 3, 0};
    for (int i = 0; i < 2; i++) {
        const double at[3] = {30, 19, 2 + 1e-3 * i};
        clear();
        for (int k = 0; k < 9; k++)
            rectangle(walls[k][0], walls[k][1], walls[k][2]);
        rectangle(at, along, across);
        rectangle(at, across, along);
        factors(9, 0, f[i], area);
    }
    ck_assert_double_eq_tol(f[0][8 * 11 + 2], f[1][8 * 11 + 2], 3e-5);
}
END_TEST

/* The judge itself: of no sheets, and of one that reaches from wall to wall, the factor is known.
 */
START_TEST(test_right)
{
    const double sheet[1] = {WIDE / 2};
    ck_assert_double_eq_tol(right_factor(sheet, 0, 0.25), closed_parallel(WIDE, 1, 1), 1e-6);
    ck_assert_double_eq_tol(right_factor(sheet, 1, 1e-9), closed_parallel(WIDE / 2, 1, 1), 1e-6);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("sheets");
    TCase *t = tcase_create("sheets");
    tcase_set_timeout(t, 120);
    tcase_add_test(t, test_right);
    tcase_add_test(t, test_row);
    tcase_add_test(t, test_joint);
    tcase_add_test(t, test_canopy);
    suite_add_tcase(suite, t);
    return suite_failures(suite) != 0;
}
