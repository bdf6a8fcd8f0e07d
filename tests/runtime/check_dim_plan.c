/* How many paths dim polygons get, and how far what they say is believed: against numbers that
 * follow from what they have found.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include "engine/dim_belief.h"
#include "engine/dim_faces.h"
#include "engine/dim_plan.h"
#include "kernel/constants.h"
#include "suite.h"

/* A thousand paths that agree about a tenth of what particles count, to a tenth of that, have
 * missed what the rest comes from; those that say nearly the same know it best. */
START_TEST(test_missed)
{
    const struct dim_faces d = {.unseen = 0};
    struct dim_polygon p = {.light = 1, .variance = 0.01, .paths = 1000, .all = 100, .square = 11};
    ck_assert_double_lt(dim_path_weight(&d, &p), 0.06);
    p.all = 950;
    p.square = 903.5;
    ck_assert_double_gt(dim_path_weight(&d, &p), 0.99);
}
END_TEST

/* Paths that find 1 or 3 W/m2, one as often as the other, on polygons of 2 W/m2 of which nothing
 * else is known. */
static void open_plan(struct dim_faces *d, struct dim_polygon *polygon, uint32_t count)
{
    const uint64_t looked = 100;
    *d = (struct dim_faces){
        .size = DIM_LARGE_ONES, .polygon = polygon, .count = count, .sure = DIM_GOAL / 2};
    for (uint32_t i = 0; i < count; i++)
        polygon[i] = (struct dim_polygon){.light = 2,
                                          .variance = 1e6,
                                          .looked = looked,
                                          .paths = looked,
                                          .sighted = looked,
                                          .rays = 4 * looked,
                                          .all = 2 * (double)looked,
                                          .square = 5 * (double)looked};
}

/* The standard error that is planned, of the light. */
static double planned(const struct dim_polygon *p)
{
    return 1 / sqrt((double)p->wanted) / 2;
}

/* All reach DIM_GOAL by the rays that there are, and where there may be more go on to what many are
 * to have; one that is too noisy gets what is left, and the others still go on. */
START_TEST(test_plan)
{
    enum { COUNT = 5 };
    const double goal = 4 / (4 * DIM_GOAL * DIM_GOAL), all = COUNT * goal;
    struct dim_polygon polygon[COUNT];
    struct dim_faces d;
    open_plan(&d, polygon, COUNT);
    dim_plan(&d, 1.1 * all, 1.1 * all);
    for (int i = 0; i < COUNT; i++)
        ck_assert(polygon[i].planned && planned(&polygon[i]) < 1.03 * DIM_GOAL);
    ck_assert_double_gt(planned(&polygon[0]), 0.9 * DIM_GOAL);
    dim_plan(&d, 1.1 * all, 5 * all);
    for (int i = 0; i < COUNT; i++)
        ck_assert_double_eq_tol(planned(&polygon[i]), d.sure, 0.03 * d.sure);
    polygon[2].square *= 1000;
    dim_plan(&d, 1.1 * all, 5 * all);
    for (int i = 0; i < COUNT; i++)
        if (i != 2)
            ck_assert_double_eq_tol(planned(&polygon[i]), d.sure, 0.03 * d.sure);
    ck_assert(!polygon[2].planned && polygon[2].wanted > polygon[2].paths);
    ck_assert_double_le(4 * (double)polygon[2].wanted,
                        1.1 * all - (COUNT - 1) * goal + COUNT * 400);
}
END_TEST

/* What is sure gets nothing more, the others what makes them sure; where paths miss something, or
 * all light is not known so well, none do. */
START_TEST(test_plan_rest)
{
    enum { COUNT = 3 };
    struct dim_polygon polygon[COUNT];
    struct dim_faces d;
    open_plan(&d, polygon, COUNT);
    polygon[1].variance = 1e-6;
    const double rays = dim_plan_rest(&d);
    ck_assert_uint_eq(polygon[1].wanted, polygon[1].paths);
    ck_assert_double_eq_tol(planned(&polygon[0]), DIM_GOAL / DIM_MARGIN, 1e-2 * DIM_GOAL);
    ck_assert_double_eq_tol(rays, 8 * (double)(polygon[0].wanted - polygon[0].paths), 1e-9 * rays);
    polygon[2].light = 20;
    polygon[2].variance = 1;
    ck_assert(isinf(dim_plan_rest(&d)));
    open_plan(&d, polygon, COUNT);
    d.shared = DIM_GOAL * DIM_GOAL;
    ck_assert(isinf(dim_plan_rest(&d)));
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("dim plan");
    TCase *tests = tcase_create("");
    tcase_add_test(tests, test_missed);
    tcase_add_test(tests, test_plan);
    tcase_add_test(tests, test_plan_rest);
    suite_add_tcase(suite, tests);
    return suite_failures(suite) > 0;
}
