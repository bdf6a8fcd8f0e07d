/* check_unseen_light.c - where none of the particles is reflected, that is said, and no more than
 * what follows from it; nothing is known, unless planes prove that nothing is reflected.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include "engine/mend_solution.h"
#include "runtime/make_solve.h"
#include "suite.h"

/* A room of 2 m whose front wall has a square hole, `hole` m on a side; 4 m before it a lamp of 1
 * W/m2, .2 m on a side, that looks at it, or away. */
static void room_with_hole(struct scene *s, double hole, int away)
{
    const double a = 1 - hole / 2, b = 1 + hole / 2;
    made_open(s);
    made_material(s, 0.5, 0);
    made_material(s, 0, 1);
    made_quad(s, 0, 0, 0, 0, 2, 0, 0, 0, 2, 0);
    made_quad(s, 0, 0, 0, 2, 0, 2, 0, 2, 0, 0);
    made_quad(s, 0, 0, 0, 0, 0, 2, 0, 0, 0, 2);
    made_quad(s, 0, 2, 0, 0, 0, 0, 2, 0, 2, 0);
    made_quad(s, 0, 0, 2, 0, 2, 0, 0, 0, 0, 2);
    made_quad(s, 0, 0, 0, 0, 0, 0, 2, a, 0, 0);
    made_quad(s, 0, b, 0, 0, 0, 0, 2, 2 - b, 0, 0);
    made_quad(s, 0, a, 0, 0, 0, 0, a, b - a, 0, 0);
    made_quad(s, 0, a, 0, b, 0, 0, 2 - b, b - a, 0, 0);
    if (away)
        made_quad(s, 1, 0.9, -4, 0.9, 0.2, 0, 0, 0, 0, 0.2);
    else
        made_quad(s, 1, 0.9, -4, 0.9, 0, 0, 0.2, 0.2, 0, 0);
}

/* Mend by no more than so many rays, and measure by a few. */
static void solve_by(struct solve *s, struct scene *scene, uint64_t rays,
                     struct measured_error *alone, struct measured_error *error)
{
    const struct mending_goal goal = {
        .noise = 0.0065, .power = 0.004, .most = rays, .places = 0.065, .least = 1 << 14};
    const char *cause;
    solve_with(s, scene, "power", RELEASE_FLAT, NULL, quick(2));
    ck_assert_int_eq(measure_and_mend(s, &goal, alone, &cause), 0);
    ck_assert_int_eq(measure_error(s, 1 << 14, 1, 0, error, &cause), 0);
}

/* What comes through a hole of .1 mm: what of the lamp's .04 W goes there, at 4 m, as far as it is
 * reflected before it goes out again, which is all but 1e-9 of .5 / (1 - .5). */
START_TEST(test_pinhole)
{
    const double hole = 1e-4, comes = 0.04 * hole * hole / (M_PI * 16), reflected = comes;
    struct scene scene;
    struct solve s;
    struct measured_error alone, error;
    room_with_hole(&scene, hole, 0);
    solve_by(&s, &scene, 1 << 18, &alone, &error);
    ck_assert_double_eq(alone.faces.reflected, 0);
    ck_assert_double_eq(error.faces.reflected, 0);
    ck_assert_double_gt(error.faces.unseen, reflected);
    ck_assert_double_lt(alone.faces.unseen, error.faces.unseen);
    ck_assert_double_lt(alone.faces.unseen, 0.04 * 3 / (double)(alone.particles - 16));
    ck_assert(isinf(error.faces.l1.high) && error.faces.power.high > 0);
    ck_assert(isinf(error.faces.power.high) && isinf(error.faces.power.low));
    ck_assert_uint_eq(alone.dim.large, 9 - 2); /* what is above and below the hole is small */
    ck_assert_uint_eq(alone.dim.unsure, alone.dim.large);
    ck_assert_uint_gt(alone.rays, 1 << 17); /* none that has been seen is no reason to end */
    measured_error_free(&alone);
    measured_error_free(&error);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* Through one of .1 or .2 m so few come that all light together is not known to 5 %, and no face is
 * known better, whatever paths say that end in this light. */
START_TEST(test_few)
{
    struct scene scene;
    struct solve s;
    struct measured_error alone, error;
    room_with_hole(&scene, _i ? 0.2 : 0.1, 0);
    solve_by(&s, &scene, 1 << 18, &alone, &error);
    ck_assert_int_eq(s.by_paths, 0);
    ck_assert_double_gt(alone.faces.reflected, 0);
    ck_assert_uint_eq(alone.dim.unsure, alone.dim.large);
    measured_error_free(&alone);
    measured_error_free(&error);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* Through one of 1 m there is light, and of that errors are told. */
START_TEST(test_window)
{
    struct scene scene;
    struct solve s;
    struct measured_error alone, error;
    room_with_hole(&scene, 1, 0);
    solve_by(&s, &scene, 1 << 20, &alone, &error);
    ck_assert_double_gt(error.faces.reflected, 0);
    ck_assert(error.faces.unseen == 0 && isfinite(error.faces.l1.high));
    measured_error_free(&alone);
    measured_error_free(&error);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* The lamp looks away: nothing is reflected, for sure, and no more rays are cast for it than at the
 * first. */
START_TEST(test_away)
{
    struct scene scene;
    struct solve s;
    struct measured_error alone, error;
    room_with_hole(&scene, 1e-4, 1);
    solve_by(&s, &scene, 1 << 22, &alone, &error);
    ck_assert(alone.faces.unseen == 0 && error.faces.unseen == 0 && error.faces.l1.high == 0);
    ck_assert_uint_lt(alone.rays, 1 << 16);
    measured_error_free(&alone);
    measured_error_free(&error);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* A red lamp in a room that reflects green and blue: nothing is reflected, for sure. With a trace
 * of blue in the lamp something is. */
START_TEST(test_other_colour)
{
    const struct solve_options options = quick(2);
    struct scene scene;
    struct solve s;
    const char *cause;
    room_with_hole(&scene, 1, 0);
    scene.bands = 3;
    for (int k = 0; k < 3; k++) {
        scene.materials[0].reflectance[k] = k ? 0.5 : 0;
        scene.materials[1].exitance[k] = k == 0 ? 1 : _i && k == 2 ? 1e-6 : 0;
    }
    ck_assert_int_eq(solve_open(&s, &scene, &options, &cause), 0);
    ck_assert_int_eq(s.problem.reflects, _i);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* So many lamps, all black, do not take their square to tell that nothing is reflected. */
START_TEST(test_black)
{
    enum { SIDE = 500 };
    const struct solve_options options = quick(2);
    struct scene scene;
    struct solve s;
    const char *cause;
    made_open_for(&scene, SIDE * SIDE);
    made_material(&scene, 0, 1);
    for (int i = 0; i < SIDE * SIDE; i++)
        made_quad(&scene, 0, i % SIDE, (double)(i / SIDE), 0, 1, 0, 0, 0, 1, 0);
    ck_assert_int_eq(solve_open(&s, &scene, &options, &cause), 0);
    ck_assert_int_eq(s.problem.reflects, 0);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("unseen light");
    TCase *tests = tcase_create("");
    tcase_add_test(tests, test_pinhole);
    tcase_add_loop_test(tests, test_few, 0, 2);
    tcase_add_test(tests, test_window);
    tcase_add_test(tests, test_away);
    tcase_add_loop_test(tests, test_other_colour, 0, 2);
    tcase_add_test(tests, test_black);
    suite_add_tcase(suite, tests);
    return suite_failures(suite) > 0;
}
