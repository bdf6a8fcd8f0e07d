/* check_sight_rays.c - shares of an exchange by rays, against what is known exactly: a small face
 * at whose foot nearly all is exchanged, and squares near each other and far apart.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include "engine/exchange_sight.h"
#include "engine/sight_rays.h"
#include "kernel/polygon_factor.h"
#include "runtime/two_squares.h"
#include "suite.h"

/* A floor, a small upright face on its middle, and a floor as large as what four walls leave. */
static void open_ring(struct scene *s, double size, double ring)
{
    made_open(s);
    made_material(s, 0.5, 0);
    made_quad(s, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0);
    made_quad(s, 0, 0.5, 0.5, 0, 0, size, 0, 0, 0, size);
    const double low = 0.5 - ring, wide = 2 * ring;
    made_quad(s, 0, low, low, 0, 0, wide, 0, 0, 0, 2);
    made_quad(s, 0, 0.5 + ring, low, 0, 0, 0, 2, 0, wide, 0);
    made_quad(s, 0, low, low, 0, 0, 0, 2, wide, 0, 0);
    made_quad(s, 0, low, 0.5 + ring, 0, wide, 0, 0, 0, 0, 2);
}

/* Of what the small face sends to the floor walls stop what goes farther than they stand; points
 * spread over the floor seldom stand there. */
START_TEST(test_foot)
{
    const double size = pow(10, -1 - _i), ring = 0.1;
    struct scene s, part;
    struct exchange_tree t, u;
    double error;
    open_ring(&s, size, ring);
    open_tree(&t, &s);
    made_open(&part);
    made_material(&part, 0.5, 0);
    made_quad(&part, 0, 0.5 - ring, 0.5 - ring, 0, 2 * ring, 0, 0, 0, 2 * ring, 0);
    made_quad(&part, 0, 0.5, 0.5, 0, 0, size, 0, 0, 0, size);
    open_tree(&u, &part);
    const double right = polygon_factor(face_of(&u, 1), face_of(&u, 0), 1)
                         / polygon_factor(face_of(&t, 1), face_of(&t, 0), 1),
                 share = sight_rays(face_of(&t, 1), face_of(&t, 0), &t.host, 1024, &error);
    ck_assert_double_lt(error, 0.02);
    ck_assert_double_le(fabs(share - right), 3 * error);
    exchange_tree_close(&u);
    made_close(&part);
    exchange_tree_close(&t);
    made_close(&s);
}
END_TEST

/* Past boxes, the same both ways, as adaptive quadrature has it; near each other, and so far apart
 * that points stand for directions. */
START_TEST(test_squares)
{
    static const double along[3][3] = {{0.2, 0, 0}, {0, 0.3, 0}, {0, 0, 0.1}};
    const double apart = _i ? 8 : 0.5;
    struct scene s;
    struct exchange_tree t;
    struct sight_scratch scratch;
    double error[2], rest;
    made_open(&s);
    made_material(&s, 0.5, 0);
    made_quad(&s, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0);
    made_quad(&s, 0, 0, 0, apart, 0, 0.7, 0, 0.8, 0, 0);
    for (int i = 0; i < 3; i++) {
        const double at[3] = {0.1 + 0.25 * i, 0.6 - 0.2 * i, apart * (0.2 + 0.2 * i)};
        made_box(&s, 0, at, along, 0);
    }
    open_tree(&t, &s);
    const struct sight_limits limits = sight_limits_for(1e-4, s.input_count, s.face_count);
    ck_assert_int_eq(sight_scratch_open(&scratch, &limits), 0);
    const struct element *a = face_of(&t, 0), *b = face_of(&t, 1);
    const double right = sight_pair(a, b, &t, NULL, &scratch, 0, &rest)
                         / (a->area * polygon_factor(a, b, 1)),
                 share[2] = {sight_rays(a, b, &t.host, 4096, &error[0]),
                             sight_rays(b, a, &t.host, 4096, &error[1])};
    ck_assert(share[0] == share[1] && error[0] == error[1]);
    ck_assert_double_gt(right, 0.3);
    ck_assert_double_lt(right, 0.9);
    ck_assert_double_lt(error[0], 0.01);
    ck_assert_double_le(fabs(share[0] - right), 3 * error[0]);
    sight_scratch_close(&scratch);
    exchange_tree_close(&t);
    made_close(&s);
}
END_TEST

/* A low face at the end of a slot between two boxes that stand on a table, some of which it sees:
 * points spread over the table all see nothing of it. */
START_TEST(test_slot)
{
    const double slot = 0.025, deep = 0.2, tall = 0.2;
    const double at[2][3] = {{-0.03, -deep, 0}, {slot, -deep, 0}},
                 along[3][3] = {{0.03, 0, 0}, {0, deep, 0}, {0, 0, tall}};
    struct scene s;
    struct exchange_tree t;
    struct sight_scratch scratch;
    double error[2];
    made_open(&s);
    made_material(&s, 0.5, 0);
    made_quad(&s, 0, -0.5, -0.8, 0, 1.7, 0, 0, 0, 0.9, 0);
    made_quad(&s, 0, 0, -0.02 * (_i + 1), 0, 0, 0, tall, slot, 0, 0);
    for (int i = 0; i < 2; i++)
        made_box(&s, 0, at[i], along, 0);
    open_tree(&t, &s);
    const struct sight_limits limits = sight_limits_for(3e-4, 1000, 1000);
    ck_assert_int_eq(sight_scratch_open(&scratch, &limits), 0);
    const struct element *a = face_of(&t, 0), *b = face_of(&t, 1);
    const double value = sight_pair(a, b, &t, NULL, &scratch, 0, &error[0]) / b->area,
                 clear = polygon_factor(b, a, 1),
                 share = sight_rays(b, a, &t.host, 4096, &error[1]);
    ck_assert_double_gt(share * clear, 0.01);
    ck_assert_double_le(fabs(value - share * clear), 3 * error[1] * clear + error[0] / b->area);
    sight_scratch_close(&scratch);
    exchange_tree_close(&t);
    made_close(&s);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("sight rays");
    TCase *tests = tcase_create("sight rays");
    suite_add_tcase(suite, tests);
    tcase_add_loop_test(tests, test_foot, 0, 4);
    tcase_add_loop_test(tests, test_squares, 0, 2);
    tcase_add_loop_test(tests, test_slot, 0, 4);
    return suite_failures(suite);
}
