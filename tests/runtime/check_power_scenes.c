/* check_power_scenes.c - what the links of the oracle power bring, by themselves, in scenes whose
 * light is known: lamps close under a ceiling, a bulb in its shade, a window under the sky.
 * SPDX-License-Identifier: MIT */
#include <stdio.h>
#include "runtime/make_solve.h"
#include "scene/read_scene.h"
#include "suite.h"

static void shine(const struct scene *scene, const char *name, double most)
{
    struct solve s;
    struct solve_options how = {.tolerance = 1e-5, .iterations = 100000, .threads = 2, .linear = 1};
    solve_with(&s, scene, "power", RELEASE_FLAT, NULL, how);
    double off = s.report.absorbed / s.report.emitted - 1;
    printf("%s: %+.2g of the power, %zu links\n", name, off, s.refinement.link_count);
    ck_assert_double_le(fabs(off), most);
    solve_close(&s);
}

/* Area means of B of the first 15 polygons and the last 5, by 2e7 particles, standard errors at
 * most 2e-4; the lamps between reflect nothing. As `solve` computes them, by links alone, 2 % of
 * what is reflected may be wrong. */
START_TEST(test_panels)
{
    static const double known[23] = {.1386, .2680, .1535,  .1139, .1278, .1593, .1939, .0410,
                                     .1713, .1722, .1098,  .0622, .1387, .1071, .0950, 0,
                                     0,     0,     .00029, .0903, .1071, .0995, .0514};
    struct solve_options options = {.iterations = 100000, .threads = 2, .linear = 1};
    struct scene_options how = {.quiet = 1};
    double power[23] = {0}, area[23] = {0}, wrong = 0, all = 0;
    struct scene scene;
    struct solve s;
    ck_assert_int_eq(scene_read(&scene, "tests/runtime/panels.obj", &how), 0);
    solve_with(&s, &scene, "power", RELEASE_FLAT, NULL, options);
    for (uint32_t i = 0; i < scene.face_count; i++) {
        uint32_t e = s.hierarchy.face_element[i], of = scene.faces[i].input;
        power[of] += s.hierarchy.elements[e].area * s.state.radiosity[(size_t)e * s.problem.bands];
        area[of] += s.hierarchy.elements[e].area;
    }
    for (int i = 0; i < 23; i++)
        if (known[i] > 0) {
            wrong += fabs(power[i] - area[i] * known[i]);
            all += area[i] * known[i];
        }
    printf("panels: %.3g of the reflected light, %zu links\n", wrong / all,
           s.refinement.link_count);
    ck_assert_double_le(wrong / all, 0.02);
    solve_close(&s);
    scene_free(&scene);
}
END_TEST

/* A closed room: what is emitted is absorbed. */
START_TEST(test_under_ceiling)
{
    struct scene scene;
    uint32_t m[6] = {0, 0, 0, 0, 0, 0};
    made_open(&scene);
    made_material(&scene, 0.6, 0);
    made_material(&scene, 0, 25);
    made_room(&scene, m, 4, 5, 2.5);
    made_quad(&scene, 1, 1.3, 3.1, 2.499, 0.5, 0, 0, 0, 0.4, 0);
    made_quad(&scene, 1, 1.3, 3.1, 2.499, 0, 0.4, 0, 0.5, 0, 0);
    shine(&scene, "a lamp 1 mm below a ceiling", 0.03);
    made_close(&scene);
}
END_TEST

/* A bulb of 128 faces in a shade of 24 panels with two sides, in a closed cube: groups of bulb and
 * shade stand near each other, and most of the light is in there. */
enum { ROUND = 16, HIGH = 8, PANELS = 24 };

static void on_bulb(double p[3], int i, int k)
{
    const double up = M_PI * k / HIGH, round = 2 * M_PI * i / ROUND;
    p[0] = 0.5 + 0.05 * sin(up) * cos(round);
    p[1] = 0.5 + 0.05 * sin(up) * sin(round);
    p[2] = 0.5 - 0.05 * cos(up);
}

static void bulb(struct scene *s, uint32_t material)
{
    for (int i = 0; i < ROUND; i++)
        for (int k = 0; k < HIGH; k++) {
            double p[4][3];
            on_bulb(p[0], i, k);
            on_bulb(p[1], i + 1, k);
            on_bulb(p[2], i + 1, k + 1);
            on_bulb(p[3], i, k + 1);
            const int below = k == 0, pole = below || k == HIGH - 1; /* two corners in one */
            made_face(s, material, pole ? 3 : 4, (const double(*)[3])(p + below));
        }
}

static void shade(struct scene *s, uint32_t material)
{
    for (int i = 0; i < PANELS; i++) {
        const double a = 2 * M_PI * i / PANELS, b = 2 * M_PI * (i + 1) / PANELS;
        const double x[2] = {cos(a), cos(b)}, y[2] = {sin(a), sin(b)}, low = 0.2, high = 0.12;
        const double inside[4][3] = {{0.5 + low * x[1], 0.5 + low * y[1], 0.38},
                                     {0.5 + low * x[0], 0.5 + low * y[0], 0.38},
                                     {0.5 + high * x[0], 0.5 + high * y[0], 0.62},
                                     {0.5 + high * x[1], 0.5 + high * y[1], 0.62}};
        double outside[4][3];
        for (int k = 0; k < 4; k++)
            memcpy(outside[k], inside[3 - k], sizeof outside[k]);
        made_face(s, material, 4, inside);
        made_face(s, material, 4, (const double(*)[3])outside);
    }
}

START_TEST(test_bulb)
{
    struct scene scene;
    uint32_t m[6] = {0, 0, 0, 0, 0, 0};
    made_open(&scene);
    made_material(&scene, 0.5, 0);
    made_material(&scene, 0.4, 400);
    made_material(&scene, 0.7, 0);
    made_room(&scene, m, 1, 1, 1);
    bulb(&scene, 1);
    shade(&scene, 2);
    shine(&scene, "a bulb in its shade", 0.015);
    made_close(&scene);
}
END_TEST

/* A wall across x with a window, 2 x 1.4 m, in it, `wide` m beyond y 0 to 4 and z 0 to 3; its front
 * towards less x, or away. */
static void windowed_wall(struct scene *s, uint32_t material, double x, double wide, int away)
{
    const double y[4] = {-wide, 1, 3, 4 + wide}, z[4] = {-wide, 0.9, 2.3, 3 + wide};
    for (int i = 0; i < 9; i++) {
        const double at[2] = {y[i % 3], z[i / 3]}, a = y[i % 3 + 1] - at[0],
                     b = z[i / 3 + 1] - at[1];
        if (i != 4)
            made_quad(s, material, x, at[0], at[1], 0, away * a, (1 - away) * b, 0, (1 - away) * a,
                      away * b);
    }
}

/* A room with walls of .2 m and a window, in the middle of a black cube of sky, 60 m. Nearly all
 * light falls on the sky. The walls have a whole sky before them from outside, and what comes in is
 * what the sky sends through the window; at rho = .02 next to nothing goes out again. */
START_TEST(test_window)
{
    enum { TILES = 5, SKY = 6 * TILES * TILES };
    const uint32_t m[6] = {1, 1, 1, 1, 1, 1};
    const double to[3] = {27, 28, 28}, outside[3] = {-0.2, -0.2, -0.2},
                 along[3][3] = {{0, 4.4, 0}, {0, 0, 3.4}, {5.4, 0, 0}};
    struct scene scene;
    struct solve s;
    double known = 0, comes_in = 0, wrong = 0;
    made_open(&scene);
    made_material(&scene, 0, 1);
    made_material(&scene, 0.02, 0);
    for (int i = 0; i < SKY; i++)
        made_tile(&scene, 0, 0, i / (TILES * TILES), i % (TILES * TILES), TILES, 1);
    made_scale(&scene, 60);
    made_room(&scene, m, 5, 4, 3);
    scene.face_count = --scene.input_count; /* the wall with the window comes by itself */
    windowed_wall(&scene, 1, 5, 0, 0);
    made_quad(&scene, 1, 5, 1, 0.9, 0.2, 0, 0, 0, 2, 0);
    made_quad(&scene, 1, 5, 1, 2.3, 0, 2, 0, 0.2, 0, 0);
    made_quad(&scene, 1, 5, 1, 0.9, 0, 0, 1.4, 0.2, 0, 0);
    made_quad(&scene, 1, 5, 3, 0.9, 0.2, 0, 0, 0, 0, 1.4);
    const uint32_t inside = scene.face_count;
    made_box(&scene, 1, outside, along, 1);
    windowed_wall(&scene, 1, 5.2, 0.2, 1);
    for (uint32_t i = SKY; i < scene.face_count; i++)
        for (int j = 0; j < 4; j++)
            for (int k = 0; k < 3; k++)
                scene.faces[i].vertex[j][k] += to[k];
    solve_with(&s, &scene, "power", RELEASE_FLAT, NULL, quick_linear(2));
    for (uint32_t i = SKY; i < scene.face_count; i++) {
        const uint32_t e = s.hierarchy.face_element[i];
        const double area = s.hierarchy.elements[e].area,
                     falls = area * s.state.radiosity[e] / 0.02;
        known += i < inside ? 0 : area;
        comes_in += i < inside ? 0.98 * falls : 0;
        wrong += i < inside ? 0 : fabs(falls - area);
    }
    wrong += fabs(comes_in - 2 * 1.4);
    known += 2 * 1.4;
    printf("by a window: %.3f comes in of 2.8, %.3g of all light is wrong, %zu links\n", comes_in,
           wrong / known, s.refinement.link_count);
    ck_assert_double_le(wrong / known, 0.01);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("power in scenes");
    TCase *c = tcase_create("power in scenes");
    tcase_set_timeout(c, 60);
    tcase_add_test(c, test_panels);
    tcase_add_test(c, test_bulb);
    tcase_add_test(c, test_window);
    tcase_add_test(c, test_under_ceiling);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
