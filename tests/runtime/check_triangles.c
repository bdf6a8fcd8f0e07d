/* check_triangles.c - triangles of concave outlines make up all of them, and none holds a corner.
 *
 * Outlines are seen from one point, so that they do not cross themselves, and go in and out from
 * corner to corner. Each triangle is held against every corner.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <stdlib.h>
#include "geometry.h"
#include "hierarchy/polygon.h"
#include "suite.h"

enum { MOST = 200 };

static double vertex[MOST][3], normal[3];
static uint32_t triangle[MOST][3], scratch[MOST];

static double random_unit(void)
{
    return rand() / (double)RAND_MAX;
}

/* n corners in a plane of any orientation, at distances from `least` to 1. */
static void make_outline(uint32_t n, double least)
{
    const double turn = random_unit(), tip = random_unit(), u[3] = {cos(turn), sin(turn), 0},
                 v[3] = {-sin(turn) * cos(tip), cos(turn) * cos(tip), sin(tip)};
    for (uint32_t i = 0; i < n; i++) {
        const double angle = 2 * acos(-1) * i / n, far = least + (1 - least) * random_unit();
        for (int k = 0; k < 3; k++)
            vertex[i][k] = 3 + far * (cos(angle) * u[k] + sin(angle) * v[k]);
    }
}

/* Twice the area of a, b, c, seen along the normal. */
static double twice_area(uint32_t a, uint32_t b, uint32_t c)
{
    double x[3], y[3], z[3];
    sub3(x, vertex[b], vertex[a]);
    sub3(y, vertex[c], vertex[a]);
    cross3(z, x, y);
    return dot3(z, normal);
}

START_TEST(test_outlines)
{
    srand((unsigned)_i + 1);
    for (int round = 0; round < 500; round++) {
        const uint32_t n = 4 + (uint32_t)rand() % (_i == 2 ? 8 : MOST - 4);
        make_outline(n, _i == 0 ? .9 : .01);
        const double area = polygon_normal(vertex, n, normal);
        ck_assert_uint_eq(polygon_triangulate(vertex, n, triangle, scratch), n - 2);
        double sum = 0;
        for (uint32_t t = 0; t < n - 2; t++) {
            const uint32_t *c = triangle[t];
            const double own = twice_area(c[0], c[1], c[2]) / 2;
            ck_assert_double_gt(own, 0);
            sum += own;
            uint32_t held = 0;
            for (uint32_t p = 0; p < n; p++)
                held += p != c[0] && p != c[1] && p != c[2] && twice_area(c[0], c[1], p) > 0
                        && twice_area(c[1], c[2], p) > 0 && twice_area(c[2], c[0], p) > 0;
            ck_assert_uint_eq(held, 0);
        }
        ck_assert_double_eq_tol(sum, area, 1e-12);
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("triangles");
    TCase *c = tcase_create("triangles");
    tcase_add_loop_test(c, test_outlines, 0, 3);
    tcase_set_timeout(c, 60);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
