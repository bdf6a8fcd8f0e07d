/* check_build.c - scenes built of arrays: what becomes of polygons, and what is refused.
 *
 * Areas by hand; polygons of many corners against the shoelace formula.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "hierarchy/scene.h"
#include "hierarchy/polygon.h"
#include "suite.h"

static const double square[12] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
static const uint32_t around[4] = {0, 1, 2, 3};
static const struct RadMaterial grey = {{0.5, 0.5, 0.5}, {1, 1, 1}, 0};

static struct RadPolygons one_square(void)
{
    return (struct RadPolygons){
        .positions = square, .position_count = 4, .indices = around, .size = 4, .count = 1};
}

static double area_of(const struct face *face)
{
    struct face f = *face;
    double normal[3];
    return polygon_normal(f.vertex, f.vertices, normal);
}

START_TEST(test_square)
{
    struct RadPolygons p = one_square();
    struct scene s;
    struct scene_error error;
    ck_assert_int_eq(scene_build(&s, &p, &grey, 1, 1, &error), 0);
    ck_assert_uint_eq(s.face_count, 1);
    ck_assert_uint_eq(s.input_count, 1);
    ck_assert_uint_eq(s.bands, 1);
    ck_assert_uint_eq(s.faces[0].vertices, 4);
    ck_assert_int_eq(memcmp(s.faces[0].vertex, square, sizeof square), 0);
    ck_assert_double_eq(s.areas[0], 1);
    scene_free(&s);
    ck_assert_ptr_null(s.faces);
}
END_TEST

/* Sizes that differ, materials that differ, two sides, no area, too few corners, the same place
 * under two indices. */
START_TEST(test_mixed)
{
    const double once[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0.5, 0, 0, 1, 0, 0};
    double at[4 * 18]; /* the same at four heights, so that nothing lies on another */
    for (int i = 0; i < 4 * 18; i++)
        at[i] = once[i % 18] + (i % 3 == 2 ? i / 18 : 0);
    const uint32_t sizes[] = {4, 3, 3, 2, 5, 0, 4},
                   indices[] = {0, 1,  2,  3,  6,  7,  8,  0,  4,  1, 0,
                                1, 12, 16, 13, 14, 15, 18, 19, 23, 20};
    const uint32_t materials[] = {0, 1, 0, 0, 2, 0, 2};
    const struct RadMaterial of[] = {grey,
                                     {{0, 0, 0}, {0, 0, 0}, 1},
                                     {{0.1, 0.2, 0.3}, {0, 0, 0}, 0},
                                     {{2, 2, 2}, {-1, 0, 0}, 0}};
    const struct RadPolygons p = {.positions = at,
                                  .position_count = 24,
                                  .indices = indices,
                                  .sizes = sizes,
                                  .materials = materials,
                                  .count = 7};
    struct scene s;
    struct scene_error error;
    ck_assert_int_eq(scene_build(&s, &p, of, 4, 1, &error), 0); /* nobody has the last material */
    ck_assert_uint_eq(s.dropped, 3);
    ck_assert_uint_eq(s.bands, 3);
    const double area[] = {1, 0.5, 0, 0, 1, 0, 0.5};
    double sum[7] = {0};
    for (uint32_t i = 0; i < s.face_count; i++) {
        ck_assert_uint_eq(s.faces[i].black, s.faces[i].input == 1);
        ck_assert_uint_eq(s.faces[i].material, materials[s.faces[i].input]);
        sum[s.faces[i].input] += s.faces[i].back ? 0 : area_of(&s.faces[i]);
        ck_assert(i == 0 || s.faces[i].input >= s.faces[i - 1].input);
    }
    for (int i = 0; i < 7; i++) {
        ck_assert_double_eq_tol(s.areas[i], area[i], 1e-15);
        ck_assert_double_eq_tol(sum[i], area[i], 1e-15);
    }
    ck_assert_uint_eq(s.faces[1].back, 0);
    ck_assert_uint_eq(s.faces[2].back, 1);
    ck_assert_uint_eq(s.faces[s.face_count - 1].vertices, 3);
    scene_free(&s);
}
END_TEST

/* A star of 3,001 corners, and 3,001 on a circle. */
START_TEST(test_many_corners)
{
    enum { N = 3001 };
    static double at[3 * N];
    static uint32_t indices[N];
    for (int star = 0; star < 2; star++) {
        double shoelace = 0, sum = 0;
        for (uint32_t i = 0; i < N; i++) {
            double angle = 2 * 3.14159265358979323846 * i / N, radius = star && i % 2 ? 0.3 : 1.0;
            at[3 * i] = radius * cos(angle);
            at[3 * i + 1] = radius * sin(angle);
            at[3 * i + 2] = 2;
            indices[i] = i;
        }
        for (uint32_t i = 0; i < N; i++) {
            const double *a = &at[3 * i], *b = &at[3 * ((i + 1) % N)];
            shoelace += 0.5 * (a[0] * b[1] - b[0] * a[1]);
        }
        const struct RadPolygons p = {
            .positions = at, .position_count = N, .indices = indices, .size = N, .count = 1};
        struct scene s;
        struct scene_error error;
        ck_assert_int_eq(scene_build(&s, &p, &grey, 1, 1, &error), 0);
        for (uint32_t i = 0; i < s.face_count; i++)
            sum += area_of(&s.faces[i]);
        ck_assert_double_eq_tol(sum, shoelace, 1e-6);
        ck_assert_double_eq_tol(s.areas[0], shoelace, 1e-6);
        scene_free(&s);
    }
}
END_TEST

/* A tilted square of 1 m whose corners have been floats, 3 km from the origin: they bend it by up
 * to 2^-13 m, which is flat enough for a scene of 1 km but not for one of 2 m, where rays keep
 * 2^-17 m off. What the corners are now does not matter. */
START_TEST(test_rounded)
{
    const double extent[] = {2, 1024};
    for (int i = 0; i < 4; i++) {
        double at[21] = {3000.1, 3000.1, 3000.1, 3000.9, 3000.5, 3000.7,
                         3000.5, 3001.3, 3001.1, 2999.7, 3000.9, 3000.5};
        const uint32_t indices[] = {0, 1, 2, 3, 4, 5, 6}, sizes[] = {4, 3};
        for (int k = 0; k < 12; k++)
            at[k] = (double)(float)at[k];
        for (int k = 0; k < 9; k++)
            at[12 + k] = (k % 3 == 2 ? 3005 : 3000) + (k == 3 || k == 7 ? extent[i / 2] : 0);
        at[11] += ldexp(1, -13);
        const struct RadPolygons p = {.positions = at,
                                      .position_count = 7,
                                      .indices = indices,
                                      .sizes = sizes,
                                      .count = 2,
                                      .single_precision = i % 2};
        struct scene s;
        struct scene_error error;
        ck_assert_int_eq(scene_build(&s, &p, &grey, 1, 1, &error), 0);
        ck_assert_uint_eq(s.face_count, i < 2 ? 3 : 2);
        scene_free(&s);
    }
}
END_TEST

/* A strip as thin as floats are apart at 3 km has no area when it has been floats, and has one
 * in doubles. */
START_TEST(test_thin)
{
    const double at[] = {3000, 0, 0, 3000.0002, 0, 0, 3000.0002, 0.3, 0, 3000, 0.3, 0,
                         3000, 0, 0, 3000,      0, 1, 3000,      1,   1, 3000, 1,   0};
    const uint32_t indices[] = {0, 1, 2, 3, 4, 5, 6, 7};
    for (int single = 0; single < 2; single++) {
        const struct RadPolygons p = {.positions = at,
                                      .position_count = 8,
                                      .indices = indices,
                                      .size = 4,
                                      .count = 2,
                                      .single_precision = single};
        struct scene s;
        struct scene_error error;
        ck_assert_int_eq(scene_build(&s, &p, &grey, 1, 1, &error), 0);
        ck_assert_uint_eq(s.dropped, (unsigned)single);
        scene_free(&s);
    }
}
END_TEST

static void expect_refusal(const struct RadPolygons *p, const struct RadMaterial *materials,
                           uint32_t count, const char *text)
{
    struct scene s;
    struct scene_error error;
    ck_assert_int_eq(scene_build(&s, p, materials, count, 1, &error), -1);
    ck_assert_int_eq(error.code, RAD_ERROR_INVALID_SCENE);
    ck_assert_msg(strstr(error.text, text) != NULL, "'%s' is not in '%s'", text, error.text);
    ck_assert_ptr_null(s.faces);
    ck_assert_ptr_null(s.materials);
    ck_assert_uint_eq(s.face_count, 0);
}

START_TEST(test_refused)
{
    const struct RadPolygons good = one_square();
    struct RadPolygons p = good;
    struct RadMaterial m = grey;
    uint32_t index[4] = {0, 1, 2, 4}, material[1] = {1};
    p.count = 0;
    expect_refusal(&p, &grey, 1, "there is no face");
    p = good;
    p.indices = NULL;
    expect_refusal(&p, &grey, 1, "without indices");
    p = good;
    p.indices = index;
    expect_refusal(&p, &grey, 1, "corner 3 of polygon 0 is position 4, but there are 4");
    p = good;
    p.materials = material;
    expect_refusal(&p, &grey, 1, "polygon 0 has material 1, but there are 1");
    expect_refusal(&good, NULL, 0, "polygon 0 has material 0, but there are 0");
    double at[12];
    for (int i = 0; i < 3; i++) {
        memcpy(at, square, sizeof at);
        at[7] = i == 0 ? NAN : i == 1 ? -INFINITY : 1e39;
        p = good;
        p.positions = at;
        expect_refusal(&p, &grey, 1,
                       i == 2 ? "beyond 3.4e38 (1e+39)" : "corner 2 of polygon 0 is not finite");
    }
    for (int i = 0; i < 3; i++)
        memcpy(&at[3 * i], &square[3 * (i % 2)], 3 * sizeof *at);
    p.size = 3;
    expect_refusal(&p, &grey, 1, "all of its 1 faces are degenerate");
    for (int i = 0; i < 12; i++)
        at[i] = 1e-30 * square[i];
    p = good;
    p.positions = at;
    expect_refusal(&p, &grey, 1, "it is 1e-30 m wide");
    for (int i = 0; i < 12; i++)
        at[i] = 1e17 * square[i];
    expect_refusal(&p, &grey, 1, "it is 1e+17 m wide, more than any scene");
    m.reflectance[2] = 1;
    expect_refusal(&good, &m, 1, "material 0 has reflectance 1;");
    m.reflectance[2] = NAN;
    expect_refusal(&good, &m, 1, "material 0 has reflectance");
    m = grey;
    m.exitance[1] = -1e-300;
    expect_refusal(&good, &m, 1, "material 0 has exitance -1e-300 W/m2");
    m.exitance[1] = INFINITY;
    expect_refusal(&good, &m, 1, "material 0 has exitance inf W/m2");
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("build");
    TCase *t = tcase_create("build");
    tcase_set_timeout(t, 60);
    tcase_add_test(t, test_square);
    tcase_add_test(t, test_mixed);
    tcase_add_test(t, test_many_corners);
    tcase_add_test(t, test_rounded);
    tcase_add_test(t, test_thin);
    tcase_add_test(t, test_refused);
    suite_add_tcase(suite, t);
    return suite_failures(suite) != 0;
}
