/* check_summary.c - what the summary says of a solve that has not converged, and why.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <string.h>

#include "captured.h"
#include "commands/summary.h"
#include "options/options.h"
#include "suite.h"

/* A made-up report, for shipped oracles settle. */
static struct RadReport report;
static struct RadSceneReport scene_report;
static struct measured measured;

/* Prints the summary into `text`; returns its JSON, which the caller frees. */
static json_t *summarise(char *text, size_t size)
{
    struct options options = {.scene = "made up", .threads = 1};
    struct open_scene scene = {.report = scene_report};
    struct solved solved = {.report = report};
    RadDevice device = radNewDevice(NULL);
    ck_assert_ptr_nonnull(device);
    RadOracle oracle = radNewOracle(device, "bf", RAD_RELEASE_FLAT);
    ck_assert_ptr_nonnull(oracle);
    const struct power_promise promise = {0};
    const struct summary summary = {.options = &options,
                                    .scene = &scene,
                                    .solved = &solved,
                                    .oracle = oracle,
                                    .measured = &measured,
                                    .promise = &promise};
    struct captured out = capture_start(STDOUT_FILENO);
    summary_print(&summary);
    capture_end(&out, text, size);
    json_t *json = summary_json(&summary);
    ck_assert_ptr_nonnull(json);
    radReleaseOracle(oracle);
    radReleaseDevice(device);
    return json;
}

/* Counts that 31 bits do not hold are what they are. */
START_TEST(test_large_counts)
{
    static const char *const names[] = {"faces", "faces_cut", "faces_cut_into", "elements",
                                        "leaves"};
    char text[4096];
    report = (struct RadReport){.passes = 1, .elements = 3000000003, .leaves = 3000000004};
    scene_report =
        (struct RadSceneReport){.polygons = 3000000000, .cut = 3000000001, .parts = 3000000002};
    json_t *json = summarise(text, sizeof text);
    for (int i = 0; i < 5; i++)
        ck_assert_int_eq(json_integer_value(json_object_get(json, names[i])), 3000000000 + i);
    scene_report = (struct RadSceneReport){0};
    json_decref(json);
}
END_TEST

/* Links change at the end of the last pass, though the iteration reached its tolerance: more of it
 * would not help. */
START_TEST(test_links_change)
{
    char text[4096];
    report = (struct RadReport){.passes = 32, .iterations = 99, .changing = 48, .residual = 1e-6};
    json_t *json = summarise(text, sizeof text);
    ck_assert_ptr_nonnull(strstr(text, "solution  32 passes, 99 sweeps, residual 1.0e-06, "
                                       "NOT converged: 48 links still change after 32 passes"));
    ck_assert_ptr_null(strstr(text, "--iterations"));
    ck_assert_int_eq(json_integer_value(json_object_get(json, "links_changing")), 48);
    ck_assert_int_eq(json_integer_value(json_object_get(json, "passes")), 32);
    ck_assert(json_is_false(json_object_get(json, "converged")));
    json_decref(json);
}
END_TEST

/* The iteration ran out of sweeps, and links change for it: coarser ones are not the remedy. */
START_TEST(test_few_sweeps_change_links)
{
    char text[4096];
    report = (struct RadReport){.passes = 8, .iterations = 11, .changing = 15, .residual = 5e-4};
    report.solved.bound = 1.8e-3;
    report.solved.tolerance = 1e-3;
    json_t *json = summarise(text, sizeof text);
    ck_assert_ptr_nonnull(strstr(text, "NOT converged: allow more --iterations"));
    ck_assert_ptr_null(strstr(text, "larger thresholds"));
    ck_assert_int_eq(json_integer_value(json_object_get(json, "links_changing")), 15);
    json_decref(json);
}
END_TEST

/* No link changes, but the iteration ran out of sweeps. */
START_TEST(test_iteration_ends)
{
    char text[4096];
    report = (struct RadReport){.passes = 1, .iterations = 2, .residual = 0.13};
    json_t *json = summarise(text, sizeof text);
    ck_assert_ptr_nonnull(strstr(text, "NOT converged: allow more --iterations"));
    ck_assert_ptr_null(strstr(text, "still change"));
    ck_assert_int_eq(json_integer_value(json_object_get(json, "links_changing")), 0);
    json_decref(json);
}
END_TEST

/* Which solver, over which projection, and to what. */
START_TEST(test_solver)
{
    char text[4096];
    report = (struct RadReport){.solver = RAD_SOLVER_SOUTHWELL,
                                .projection = RAD_PROJECTION_COLLOCATION,
                                .solved = {2e-4, 5e-4, 5e-3}};
    json_t *json = summarise(text, sizeof text), *solver = json_object_get(json, "solver");
    ck_assert_ptr_nonnull(
        strstr(text, "solver    southwell, collocation: iteration left at most "
                     "2.0e-04 of B, 5.0e-04 allowed beside the elements' own 5.0e-03\n"));
    ck_assert_str_eq(json_string_value(json_object_get(solver, "method")), "southwell");
    ck_assert_str_eq(json_string_value(json_object_get(solver, "projection")), "collocation");
    ck_assert(json_is_false(json_object_get(solver, "tolerance_given")));
    ck_assert_double_eq(json_real_value(json_object_get(solver, "bound")), 2e-4);
    ck_assert_double_eq(json_real_value(json_object_get(solver, "tolerance")), 5e-4);
    ck_assert_double_eq(json_real_value(json_object_get(solver, "variation")), 5e-3);
    json_decref(json);
    report.solved.bound = (double)INFINITY; /* where rows allow of none */
    json = summarise(text, sizeof text);
    ck_assert(json_is_null(json_object_get(json_object_get(json, "solver"), "bound")));
    json_decref(json);
}
END_TEST

START_TEST(test_converged)
{
    char text[4096];
    report = (struct RadReport){.passes = 2, .iterations = 9, .residual = 1e-6, .converged = 1};
    json_t *json = summarise(text, sizeof text);
    ck_assert_ptr_nonnull(strstr(text, "residual 1.0e-06, converged\n"));
    ck_assert(json_is_true(json_object_get(json, "converged")));
    ck_assert(json_is_integer(json_object_get(json, "links_changing")));
    json_decref(json);
}
END_TEST

/* What the error is, in words: surely off, not surely off, and the links alone. */
START_TEST(test_error)
{
    char text[4096];
    report = (struct RadReport){.passes = 2, .converged = 1, .seconds = {.build = 1}};
    measured = (struct measured){.measured = 1,
                                 .error = {.power = {0.171, 0.161, 0.181},
                                           .l1_faces = {0.174, 0.162, 0.183},
                                           .reflected = 1,
                                           .worst = 0,
                                           .worst_share = 0.28,
                                           .seconds = 2}};
    /* the scene has no faces, hence none is the worst */
    json_decref(summarise(text, sizeof text));
    ck_assert_ptr_nonnull(strstr(text,
                                 "\nerror     reflected light per face: off by 17 % (16 to 18), "
                                 "17 % too much in all; no large face is surely wrong\n"));
    ck_assert_ptr_null(strstr(text, "mended"));
    ck_assert_ptr_nonnull(strstr(text, "\ntime      3.00 s: "));
    measured.mended = 1;
    measured.alone = measured.error;
    measured.alone.power = (struct RadMeasure){-0.012, -0.02, -0.004};
    measured.alone.rays = 250000;
    measured.error.l1_faces = (struct RadMeasure){0.003, 0, 0.006};
    measured.error.power = (struct RadMeasure){0.001, -0.012, 0.014};
    json_decref(summarise(text, sizeof text));
    ck_assert_ptr_nonnull(strstr(text,
                                 "\nmended    by particles (2.5e+05 rays); the links alone are "
                                 "off by 17 % (16 to 18) per face, 1.2 % too little in all\n"));
    ck_assert_ptr_nonnull(strstr(text, "per face: off by at most 0.6 %; no large"));
    ck_assert_ptr_nonnull(strstr(text, "\ntime      5.00 s: "));
    measured.error.power = (struct RadMeasure){0.001, -0.002, 0.004};
    json_decref(summarise(text, sizeof text));
    ck_assert_ptr_nonnull(
        strstr(text, "off by at most 0.6 %, in all right within 0.4 %; no large"));
    measured = (struct measured){0};
}
END_TEST

/* What nobody knows is not called right: large faces, small ones, and noise that is no error. */
START_TEST(test_unknown)
{
    char text[4096];
    report = (struct RadReport){.passes = 2, .converged = 1};
    measured = (struct measured){
        .measured = 1,
        .mended = 1,
        .error = {.l1_faces = {0, 0, 0.26}, .reflected = 1, .particles = 2000000},
        .alone = {.l1_faces = {0, 0, 0.091},
                  .reflected = 1,
                  .large = 37,
                  .unsure = 36,
                  .small_unsure = 24,
                  .small_area = 168.3},
    };
    json_t *json = summarise(text, sizeof text), *mended = json_object_get(json, "correction");
    ck_assert_ptr_nonnull(strstr(text, "off by at most 26 %, as far as 2e+06 particles tell, in "
                                       "all right within 0.01 %; no large face is surely wrong, "
                                       "but 36 of 37 are not known\n"));
    ck_assert_ptr_nonnull(strstr(text, "\nsmall     24 faces of 168 m2 in all, each below 1 % of "
                                       "the area, are not known to 5 %\n"));
    ck_assert_int_eq(json_integer_value(json_object_get(mended, "small_faces_unsure")), 24);
    ck_assert_double_eq(json_real_value(json_object_get(mended, "small_faces_unsure_area")), 168.3);
    json_decref(json);
    measured.alone.small_unsure = 1;
    measured.error.l1_faces.high = 0.18; /* less than twice of what was known before */
    json_decref(summarise(text, sizeof text));
    ck_assert_ptr_nonnull(strstr(text, "off by at most 18 %, in all"));
    ck_assert_ptr_nonnull(strstr(text, "\nsmall     1 face of 168 m2 in all, each below 1 % of "
                                       "the area, is not known to 5 %\n"));
    measured.alone.small_unsure = measured.alone.unsure = 0;
    json_decref(summarise(text, sizeof text));
    ck_assert_ptr_nonnull(strstr(text, "; no large face is surely wrong\n"));
    ck_assert_ptr_null(strstr(text, "\nsmall"));
    measured = (struct measured){0};
}
END_TEST

/* The worst face of four, 3, that is off by a share of its light: what is printed of it. */
static void print_worst(char *text, size_t size, double share, double sure)
{
    measured = (struct measured){.measured = 1,
                                 .error = {.l1_faces = {0.1, 0.09, 0.11},
                                           .reflected = 1,
                                           .worst = 3,
                                           .worst_share = share,
                                           .worst_sure = sure}};
    struct captured out = capture_start(STDOUT_FILENO);
    measured_print(&measured, 4, 0);
    capture_end(&out, text, size);
    measured = (struct measured){0};
}

START_TEST(test_worst_face)
{
    char text[4096];
    print_worst(text, sizeof text, -0.2, 0.03);
    ck_assert_ptr_nonnull(strstr(text, "; worst large face 3: 20 % too dark, at the least 3\n"));
    print_worst(text, sizeof text, 9, 8);
    ck_assert_ptr_nonnull(
        strstr(text, "; worst large face 3: 9e+02 % too bright, at the least 8e+02\n"));
    print_worst(text, sizeof text, 270, 200);
    ck_assert_ptr_nonnull(
        strstr(text, "; worst large face 3: 271 times as bright as it should be\n"));
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("summary");
    TCase *c = tcase_create("converged");
    tcase_add_test(c, test_large_counts);
    tcase_add_test(c, test_links_change);
    tcase_add_test(c, test_few_sweeps_change_links);
    tcase_add_test(c, test_iteration_ends);
    tcase_add_test(c, test_converged);
    tcase_add_test(c, test_error);
    tcase_add_test(c, test_unknown);
    tcase_add_test(c, test_worst_face);
    tcase_add_test(c, test_solver);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
