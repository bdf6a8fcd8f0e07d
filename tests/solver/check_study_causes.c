/* check_study_causes.c - `radiosity study causes`, run as the user would: several scenes, a table
 * of each, and JSON in which causes add up.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "command.h"
#include "folder.h"
#include "suite.h"

/* Returns the exit status; standard output goes to FOLDER/out. */
static int run(const char *more)
{
    return shell("$RADIOSITY study causes %s >%s/out 2>%s/err", more, folder, folder);
}

static double number(const json_t *object, const char *key, const char *value)
{
    const json_t *x = json_object_get(json_object_get(object, key), value);
    ck_assert_msg(json_is_real(x), "%s.%s", key, value);
    return json_real_value(x);
}

/* The sum over causes of one of their measures. */
static double sum_of(json_t *scene, const char *what)
{
    const char *key;
    json_t *cause;
    double sum = 0;
    json_object_foreach(json_object_get(scene, "causes"), key, cause)
    {
        (void)key;
        ck_assert_double_le(number(cause, what, "low"), number(cause, what, "value"));
        ck_assert_double_le(number(cause, what, "value"), number(cause, what, "high"));
        sum += number(cause, what, "value");
    }
    return sum;
}

START_TEST(test_scenes)
{
    char more[512], text[8192];
    snprintf(more, sizeof more,
             "examples/scenes/cornell.obj examples/scenes/furnace.obj --rays 100000 "
             "--oracle bf_guarded --set relative=0.5 --json %s",
             in_folder("causes.json"));
    ck_assert_int_eq(run(more), 0);
    json_t *scenes = json_load_file(in_folder("causes.json"), 0, NULL);
    ck_assert_uint_eq(json_array_size(scenes), 2);
    for (size_t i = 0; i < 2; i++) {
        json_t *scene = json_array_get(scenes, i), *all = json_object_get(scene, "together");
        const char *name = json_string_value(json_object_get(scene, "scene"));
        ck_assert_str_eq(name, i ? "examples/scenes/furnace.obj" : "examples/scenes/cornell.obj");
        ck_assert_double_eq_tol(sum_of(scene, "power"), number(all, "power", "value"), 1e-9);
        ck_assert_double_eq_tol(sum_of(scene, "after"), number(all, "after", "value"), 1e-9);
        ck_assert(sum_of(scene, "l1") >= 0 && sum_of(scene, "after_l1") >= 0);
    }
    json_decref(scenes);
    /* a table of each, and no row of groups, of which there are none */
    FILE *in = fopen(in_folder("out"), "r");
    ck_assert_ptr_nonnull(in);
    text[fread(text, 1, sizeof text - 1, in)] = 0;
    (void)fclose(in);
    char *first = strstr(text, "cornell.obj, oracle bf_guarded: ");
    ck_assert_ptr_nonnull(first);
    ck_assert_ptr_nonnull(strstr(first, "furnace.obj, oracle bf_guarded: "));
    ck_assert_ptr_nonnull(strstr(text, "\nlinks seen whole"));
    ck_assert_ptr_null(strstr(text, "groups"));
}
END_TEST

/* What cannot be read is told, and no table stands for it. */
START_TEST(test_missing)
{
    char more[256];
    snprintf(more, sizeof more, "examples/scenes/furnace.obj none.obj --rays 1000 --json %s -q",
             in_folder("missing.json"));
    ck_assert_int_eq(run(more), 1);
    ck_assert_int_ne(access(in_folder("missing.json"), F_OK), 0);
}
END_TEST

int main(void)
{
    if (folder_make("causes") < 0)
        return 1;
    Suite *suite = suite_create("study causes");
    TCase *all = tcase_create("all");
    tcase_set_timeout(all, 60);
    tcase_add_test(all, test_scenes);
    tcase_add_test(all, test_missing);
    suite_add_tcase(suite, all);
    int failed = suite_failures(suite);
    folder_remove();
    return failed != 0;
}
