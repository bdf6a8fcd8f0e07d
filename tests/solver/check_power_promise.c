/* check_power_promise.c - an oracle's tolerance in watts is kept, or it is told that it is not: in
 * a unit cube whose light is known.
 * Once is enough: it is about numbers; that memory is used well, shorter suites tell.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <jansson.h>
#include "command.h"
#include "folder.h"
#include "suite.h"

/* The ceiling emits 1 W/m2, rho = .5: its B, the floor's and a wall's, to 1e-7
 * (power adds up to 2 W). */
static const double known[6] = {1.1043616, 0.1712161, 0.1811056, 0.1811056, 0.1811056, 0.1811056};

static void write_cube(void)
{
    folder_write("cube.mtl",
                 "newmtl lamp\nKd 0.5 0.5 0.5\nKe 1 1 1\nnewmtl wall\nKd 0.5 0.5 0.5\n");
    folder_write(
        "cube.obj",
        "mtllib cube.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
        "usemtl lamp\nf 5 8 7 6\nusemtl wall\nf 1 2 3 4\nf 1 5 6 2\nf 2 6 7 3\nf 3 7 8 4\n"
        "f 4 8 5 1\n");
}

/* Solve the cube; returns its JSON, and the power that is wrong in all (W). */
static json_t *solve(const char *options, double *wrong)
{
    char line[512];
    write_cube();
    ck_assert_int_eq(shell("cd %s && $RADIOSITY solve cube.obj %s --faces faces.csv --json out.json"
                           " > out 2> log",
                           folder, options),
                     0);
    FILE *f = fopen(in_folder("faces.csv"), "r");
    ck_assert_ptr_nonnull(f);
    ck_assert_ptr_nonnull(fgets(line, sizeof line, f));
    *wrong = 0;
    for (int i = 0; i < 6; i++) {
        double b;
        ck_assert_ptr_nonnull(fgets(line, sizeof line, f));
        ck_assert_int_eq(sscanf(line, "%*d,%*[^,],%*f,%*f,%*f,%*f,%lf", &b), 1);
        *wrong += fabs(b - known[i]);
    }
    (void)fclose(f);
    json_t *json = json_load_file(in_folder("out.json"), 0, NULL);
    ck_assert_ptr_nonnull(json);
    return json;
}

static double of_promise(const json_t *json, const char *name)
{
    return json_number_value(json_object_get(json_object_get(json, "promise"), name));
}

/* Links that are far too coarse for what they promise, alone: it is told, with an interval that has
 * the truth in it. */
START_TEST(test_broken)
{
    double wrong;
    json_t *json = solve("--oracle thermal --set tolerance_watts=0.01 --set share=0 --set links=1 "
                         "--basis constant --no-correct",
                         &wrong);
    ck_assert_double_gt(wrong, 0.02);
    ck_assert_double_eq_tol(of_promise(json, "tolerance"), 0.01, 1e-15);
    ck_assert(of_promise(json, "low") <= wrong && of_promise(json, "high") >= wrong);
    ck_assert(of_promise(json, "low") > 0.01);
    ck_assert(json_is_false(json_object_get(json_object_get(json, "promise"), "kept")));
    ck_assert(folder_holds("log", "warning: the oracle promised")
              && folder_holds("log", "but they are off by"));
    ck_assert(folder_holds("out", "not kept"));
    json_decref(json);
}
END_TEST

/* The same links, mended: kept, and shown to be. */
START_TEST(test_mended)
{
    double wrong;
    json_t *json =
        solve("--oracle thermal --set tolerance_watts=0.01 --set share=0 --set links=1", &wrong);
    ck_assert_double_le(wrong, 0.01);
    ck_assert(of_promise(json, "high") <= 0.01 && of_promise(json, "high") >= wrong);
    ck_assert(json_is_true(json_object_get(json_object_get(json, "promise"), "kept")));
    ck_assert(!folder_holds("log", "promised") && folder_holds("out", "kept, off by at most"));
    json_decref(json);
}
END_TEST

/* The share is a promise, too; not measured is said; who promises nothing is not held to it. */
START_TEST(test_others)
{
    double wrong;
    json_t *json = solve("--oracle thermal --set share=0.1 --set links=100", &wrong);
    /* of the irradiance to expect, <E> / (1 - rho), over 6 m2 */
    ck_assert_double_eq_tol(of_promise(json, "tolerance"), 0.1 * (1 / 6.0 / 0.5) * 6, 1e-9);
    ck_assert(json_is_true(json_object_get(json_object_get(json, "promise"), "kept")));
    json_decref(json);
    json = solve("--oracle thermal --set links=100 --no-errors", &wrong);
    ck_assert(json_is_null(json_object_get(json_object_get(json, "promise"), "value")));
    ck_assert(folder_holds("out", "not measured"));
    json_decref(json);
    json = solve("--oracle bf", &wrong);
    ck_assert(json_is_null(json_object_get(json, "promise")) && !folder_holds("out", "promise"));
    json_decref(json);
}
END_TEST

int main(void)
{
    if (folder_make("watts") < 0)
        return 1;
    Suite *suite = suite_create("power promise");
    TCase *c = tcase_create("power promise");
    tcase_set_timeout(c, 120);
    tcase_add_test(c, test_broken);
    tcase_add_test(c, test_mended);
    tcase_add_test(c, test_others);
    suite_add_tcase(suite, c);
    int failed = suite_failures(suite);
    folder_remove();
    return failed != 0;
}
