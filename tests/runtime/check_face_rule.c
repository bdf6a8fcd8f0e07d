/* check_face_rule.c - the rules inside faces against monomials in closed form, on a square and on a
 * triangle; and that no two points of a quad are as far along a side, for shades that repeat.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>

#include "engine/face_rule.h"
#include "suite.h"

enum { DEGREE = 5 };

static const struct element square = {
    .vertices = 4, .area = 1, .normal = {0, 0, 1}, .vertex = {{0}, {1}, {1, 1}, {0, 1}}};
static const struct element triangle = {
    .vertices = 3, .area = 0.5, .normal = {0, 0, 1}, .vertex = {{0}, {1}, {0, 1}}};

/* Of x^a y^b, its mean by the rule. */
static double mean_of(const struct element *e, int a, int b)
{
    struct face_rule rule;
    double sum = 0;
    face_rule_of(&rule, e, 0);
    for (int i = 0; i < rule.count; i++)
        sum += rule.weight[i] * pow(rule.x[0][i], a) * pow(rule.x[1][i], b);
    return sum / rule.all;
}

START_TEST(test_square)
{
    for (int a = 0; a <= DEGREE; a++)
        for (int b = 0; a + b <= DEGREE; b++)
            ck_assert_double_eq_tol(mean_of(&square, a, b), 1.0 / ((a + 1) * (b + 1)), 1e-14);
    ck_assert_double_gt(fabs(mean_of(&square, 6, 0) - 1 / 7.0), 1e-5);
}
END_TEST

/* The mean of x^a y^b over it is 2 a! b! / (a + b + 2)!. */
START_TEST(test_triangle)
{
    for (int a = 0; a < DEGREE; a++)
        for (int b = 0; a + b < DEGREE; b++)
            ck_assert_double_eq_tol(mean_of(&triangle, a, b),
                                    2 * tgamma(a + 1) * tgamma(b + 1) / tgamma(a + b + 3), 1e-14);
}
END_TEST

START_TEST(test_apart)
{
    struct face_rule rule;
    face_rule_of(&rule, &square, 0);
    for (int i = 0; i < rule.count; i++)
        for (int j = 0; j < i; j++)
            for (int k = 0; k < 2; k++)
                ck_assert_double_gt(fabs(rule.x[k][i] - rule.x[k][j]), 0.05);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("face rule");
    TCase *tests = tcase_create("face rule");
    suite_add_tcase(suite, tests);
    tcase_add_test(tests, test_square);
    tcase_add_test(tests, test_triangle);
    tcase_add_test(tests, test_apart);
    return suite_failures(suite);
}
