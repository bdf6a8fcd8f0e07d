/* check_solve.c - solutions against exact ones, and what must not change them: threads, releases,
 * units. Sources: furnace, plates and cube from closed forms and converged integral-equation
 * solutions (two parallel unit squares, two perpendicular unit squares, a cube with one emitting
 * face).
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "hand.h"
#include "runtime/make_solve.h"
#include "command.h"
#include "suite.h"

/* B = E / (1 - rho) in any closed shape, at the default parameters. */
START_TEST(test_furnace)
{
    static void (*const shape[3])(struct scene *, double) = {furnace_cube, furnace_prism,
                                                             furnace_octahedron};
    static const char *const name[3] = {"cube", "prism", "octahedron"};
    static const double rho[3] = {0.5, 0.9, 0.99};
    static const char *const oracle[2] = {"bf_guarded", "bf"};
    struct scene scene;
    double worst = 0;
    shape[_i % 3](&scene, rho[_i / 3 % 3]);
    struct solve s;
    solve_with(&s, &scene, oracle[_i / 9], RELEASE_FLAT, NULL, quick(2));
    for (uint32_t i = 0; i < s.hierarchy.count; i++)
        if (s.hierarchy.elements[i].vertices)
            worst = fmax(worst, fabs(s.state.radiosity[i] * (1 - rho[_i / 3 % 3]) - 1));
    printf("furnace %s rho %.2f %s: worst element off by %.1e; rows %.4f to %.4f before the cap\n",
           name[_i % 3], rho[_i / 3 % 3], oracle[_i / 9], worst, s.report.rows.low,
           s.report.rows.high);
    ck_assert_double_le(worst, 1e-3);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* A cube, ceiling E = 1, rho = .5: the continuous solution's means. The error falls with
 * epsilon. */
START_TEST(test_cube)
{
    static char *settings[3][5] = {{"relative=0", "epsilon=0.1", "min_share=1e-6", NULL},
                                   {"relative=0", "epsilon=0.01", "min_share=1e-6", NULL},
                                   {"relative=0", "epsilon=0.002", "min_share=1e-6", NULL}};
    double error[3];
    int steps = thorough() ? 3 : 2;
    for (int i = 0; i < steps; i++) {
        uint32_t m[6];
        struct scene scene;
        made_open(&scene);
        uint32_t wall = made_material(&scene, 0.5, 0);
        uint32_t lamp = made_material(&scene, 0.5, 1);
        for (uint32_t f = 0; f < 6; f++)
            m[f] = f == 1 ? lamp : wall;
        made_room(&scene, m, 1, 1, 1);
        struct solve s;
        solve_with(&s, &scene, "bf", RELEASE_FLAT, settings[i], quick(2));
        error[i] =
            fmax(fabs(face_radiosity(&s, 1) - 1.1043616), fabs(face_radiosity(&s, 0) - 0.1712161));
        for (uint32_t f = 2; f < 6; f++)
            error[i] = fmax(error[i], fabs(face_radiosity(&s, f) - 0.1811056));
        printf("cube epsilon %s: worst face mean off by %.1e\n", settings[i][1], error[i]);
        solve_close(&s);
        made_close(&scene);
    }
    ck_assert_double_lt(error[1], error[0]);
    ck_assert_double_lt(error[1], 3e-3);
    if (steps > 2)
        ck_assert_double_lt(error[2], 1e-3);
}
END_TEST

/* Open scenes: two parallel, then two perpendicular unit squares, E = 1, rho = .5. */
START_TEST(test_plates)
{
    static char *settings[] = {"relative=0.003", "min_share=1e-6", NULL};
    struct scene scene;
    made_open(&scene);
    made_material(&scene, 0.5, 1);
    made_quad(&scene, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0);
    if (_i == 0)
        made_quad(&scene, 0, 0, 0, 1, 0, 1, 0, 1, 0, 0);
    else
        made_quad(&scene, 0, 0, 0, 0, 0, 0, 1, 1, 0, 0);
    struct solve s;
    solve_with(&s, &scene, "bf_guarded", RELEASE_FLAT, settings, quick(2));
    ck_assert_double_eq_tol(face_radiosity(&s, 0), _i == 0 ? 1.111165244298 : 1.1159537, 5e-4);
    ck_assert_double_eq_tol(face_radiosity(&s, 1), face_radiosity(&s, 0), 2e-4);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* Coarse: solutions are compared with each other. */
static char *coarse[] = {"min_share=1e-3", NULL};

/* Threads, releases and methods give the same links to the bit. */
START_TEST(test_same_links)
{
    static const char *const oracle[3] = {"bf", "bf_guarded", "power"};
    struct solve one, other;
    struct scene scene;
    furnished(&scene, 1);
    solve_with(&one, &scene, oracle[_i], RELEASE_FLAT, thorough() ? NULL : coarse, quick(1));
    for (int k = 0; k < 4; k++) {
        solve_with(&other, &scene, oracle[_i],
                   k == 1   ? RELEASE_DAG
                   : k == 2 ? RELEASE_HAND
                            : RELEASE_FLAT,
                   thorough() ? NULL : coarse, quick(k == 3 ? 5 : 2));
        same_links(&one, &other);
        ck_assert(
            memcmp(one.state.radiosity, other.state.radiosity, one.hierarchy.count * sizeof(double))
            == 0);
        solve_close(&other);
    }
    solve_close(&one);
    made_close(&scene);
}
END_TEST

/* Brightness and epsilon times 1000: the same links. */
START_TEST(test_brightness)
{
    static char *dim[] = {"relative=0", "epsilon=0.05", NULL},
                *bright[] = {"relative=0", "epsilon=50", NULL};
    struct solve one, other;
    struct scene scene;
    furnished(&scene, 1);
    solve_with(&one, &scene, "bf", RELEASE_FLAT, dim, quick(2));
    made_close(&scene);
    furnished(&scene, 1000);
    solve_with(&other, &scene, "bf", RELEASE_FLAT, bright, quick(2));
    same_links(&one, &other);
    ck_assert_double_eq_tol(face_radiosity(&other, 0) / face_radiosity(&one, 0), 1000, 1e-6);
    solve_close(&one);
    solve_close(&other);
    made_close(&scene);
}
END_TEST

/* All lengths times 2^10 and 2^-10: the same links and radiosities, to the bit, without touching
 * a parameter. */
START_TEST(test_scale)
{
    struct scene scene, scaled;
    struct solve one, other;
    furnished(&scene, 1);
    furnished(&scaled, 1);
    made_scale(&scaled, _i ? 1024 : 1 / 1024.0);
    char **settings = thorough() ? NULL : coarse;
    solve_with(&one, &scene, "bf_guarded", RELEASE_FLAT, settings, quick(2));
    solve_with(&other, &scaled, "bf_guarded", RELEASE_FLAT, settings, quick(2));
    same_links(&one, &other);
    ck_assert(
        memcmp(one.state.radiosity, other.state.radiosity, one.hierarchy.count * sizeof(double))
        == 0);
    solve_close(&one);
    solve_close(&other);
    made_close(&scene);
    made_close(&scaled);
}
END_TEST

/* Jacobi and Gauss-Seidel agree, and power is conserved to a few percent. */
START_TEST(test_methods)
{
    struct solve one, other;
    struct solve_options jacobi = quick(2);
    jacobi.solver = RAD_SOLVER_JACOBI;
    struct scene scene;
    furnished(&scene, 1);
    solve_with(&one, &scene, "bf_guarded", RELEASE_FLAT, NULL, quick(2));
    solve_with(&other, &scene, "bf_guarded", RELEASE_FLAT, NULL, jacobi);
    for (uint32_t i = 0; i < scene.face_count; i++)
        ck_assert_double_eq_tol(face_radiosity(&one, i) / face_radiosity(&other, i), 1, 1e-3);
    ck_assert_int_lt(one.report.sweeps, other.report.sweeps);
    ck_assert_double_eq_tol(one.report.absorbed / one.report.emitted, 1, 0.03);
    solve_close(&one);
    solve_close(&other);
    made_close(&scene);
}
END_TEST

/* A wall without thickness between a lit and a dark room, its front to either side: nothing
 * passes. */
START_TEST(test_wall)
{
    struct scene scene;
    made_open(&scene);
    uint32_t grey = made_material(&scene, 0.7, 0);
    uint32_t lamp = made_material(&scene, 0.5, 10);
    /* the dark room from x = 0 to 1, the lit one to 2 */
    for (uint32_t side = 0; side < 2; side++) {
        double x = side;
        made_quad(&scene, grey, x, 0, 0, 1, 0, 0, 0, 1, 0);
        made_quad(&scene, grey, x, 0, 1, 0, 1, 0, 1, 0, 0);
        made_quad(&scene, grey, x, 0, 0, 0, 0, 1, 1, 0, 0);
        made_quad(&scene, grey, x, 1, 0, 1, 0, 0, 0, 0, 1);
    }
    made_quad(&scene, grey, 0, 0, 0, 0, 1, 0, 0, 0, 1);
    made_quad(&scene, lamp, 2, 0, 0, 0, 0, 1, 0, 1, 0);
    if (_i == 0)
        made_quad(&scene, grey, 1, 0, 0, 0, 1, 0, 0, 0, 1); /* faces the lamp */
    else
        made_quad(&scene, grey, 1, 0, 0, 0, 0, 1, 0, 1, 0); /* turns its black back on it */
    struct solve s;
    solve_with(&s, &scene, "bf_guarded", RELEASE_FLAT, NULL, quick(2));
    for (uint32_t i = 0; i < 4; i++) {
        ck_assert(face_radiosity(&s, i) == 0);
        ck_assert_double_gt(face_radiosity(&s, i + 4), 0.5);
    }
    ck_assert(face_radiosity(&s, 8) == 0);
    ck_assert(_i == 0 ? face_radiosity(&s, 10) > 0.5 : face_radiosity(&s, 10) == 0);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* The paper's scenes: every release of both oracles decides alike (run as the user would). */
START_TEST(test_compare)
{
    static const char *const scene[] = {"cornell", "room", "maze_8", "furnace", "td"};
    static const char *const oracle[] = {"bf", "bf_guarded"};
    ck_assert_int_eq(shell("$RADIOSITY compare examples/scenes/%s.obj --oracle %s --repeats 1 "
                           "--set relative=0.5 --set min_share=1e-3%s > /dev/null",
                           scene[_i / 2], oracle[_i % 2],
                           _i % 2 ? " --set shadow=0.1 --set faint=1e-3" : ""),
                     0);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("solve");
    TCase *c = tcase_create("solve");
    tcase_set_timeout(c, 600);
    tcase_add_loop_test(c, test_furnace, 0, thorough() ? 18 : 9);
    tcase_add_test(c, test_cube);
    tcase_add_loop_test(c, test_plates, 0, 2);
    tcase_add_loop_test(c, test_same_links, 0, 3);
    tcase_add_test(c, test_brightness);
    tcase_add_loop_test(c, test_scale, 0, 2);
    tcase_add_test(c, test_methods);
    tcase_add_loop_test(c, test_wall, 0, 2);
    tcase_add_loop_test(c, test_compare, 0, thorough() ? 10 : 8);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
