/* check_error.c - `radiosity error`: tables whose errors are worked out by hand, and what it says
 * of tables that cannot be compared.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <jansson.h>
#include "command.h"
#include "folder.h"
#include "suite.h"

/* What stands in a file of the folder, its first 8 kB. */
static const char *text_of(const char *name)
{
    static char text[8192];
    FILE *f = fopen(in_folder(name), "r");
    ck_assert_ptr_nonnull(f);
    text[fread(text, 1, sizeof text - 1, f)] = 0;
    fclose(f);
    return text;
}

/* The exit status of `radiosity error a.csv b.csv ...`; what it says is in out and err. */
static int run(const char *rest)
{
    return shell("cd %s && $RADIOSITY error a.csv b.csv %s > out 2> err", folder, rest);
}

/* Compare two tables; the JSON, to be given back to json_decref. */
static json_t *compare(const char *faces, const char *reference)
{
    folder_write("a.csv", faces);
    folder_write("b.csv", reference);
    int status = run("--json x.json");
    ck_assert_msg(status == 0, "exit %d: %s", status, text_of("err"));
    json_error_t error;
    json_t *json = json_load_file(in_folder("x.json"), 0, &error);
    ck_assert_msg(json != NULL, "%s", error.text);
    return json;
}

static void is(const json_t *json, const char *group, const char *name, double want)
{
    const json_t *at = group ? json_object_get(json, group) : json;
    double got = json_number_value(json_object_get(at, name));
    ck_assert_msg(fabs(got - want) <= 1e-9 * fmax(1, fabs(want)), "%s %s: %.12g, not %.12g",
                  group ? group : "", name, got, want);
}

/* Reflected: 2 W on each of two walls of 2 and 4 m2 with B_ref 2 and 1; errors .2 and -.2. */
#define FACES \
    "face,material,area,E_0,rho_0,H_0,B_0\n0,lamp,1,10,0,7,10\n1,wall,2,0,.5,4.4,2.2\n" \
    "2,\"a, \"\"b\"\"\",4,0,.5,1.6,.8\n"
#define REFERENCE "face,area,B_0,se_0\n0,1,10,0\n1,2,2,.1\n2,4,1,.05\n"

START_TEST(worked_by_hand)
{
    json_t *json = compare(FACES, REFERENCE);
    is(json, NULL, "faces", 3);
    is(json, NULL, "compared", 3);
    is(json, NULL, "reflected_watts", 8);
    is(json, NULL, "error_watts", 1.2);
    is(json, NULL, "power_watts", -0.4);
    is(json, "error", "power", -0.05);
    is(json, "error", "l1_faces", 0.15);
    is(json, "error", "l2", sqrt(0.24 / 12));
    is(json, "error", "linf", 0.1);
    is(json, "noise", "power", sqrt(0.08) / 8);
    is(json, "noise", "l1_faces", 0.4 * sqrt(2 / M_PI) / 8);
    is(json, "noise", "l2", sqrt(0.03 / 12));
    ck_assert(json_is_null(json_object_get(json_object_get(json, "noise"), "linf")));
    const json_t *worst = json_array_get(json_object_get(json, "worst"), 0);
    is(worst, NULL, "face", 2);
    is(worst, NULL, "area", 4);
    is(worst, NULL, "error_watts", 0.8);
    ck_assert_str_eq(json_string_value(json_object_get(worst, "material")), "a, \"b\"");
    ck_assert_double_eq_tol(
        json_number_value(json_array_get(json_object_get(worst, "standard_errors"), 0)), -4, 1e-9);
    json_decref(json);
    ck_assert_ptr_nonnull(strstr(text_of("out"), "off by 15.00 %, 5.00 % too little in all\n"));
    ck_assert_ptr_nonnull(strstr(text_of("out"), "       2  a, \"b\" "));
    ck_assert_ptr_nonnull(strstr(text_of("out"), "-4.0\n"));
    ck_assert_str_eq(text_of("err"), "");
    /* the other way round: too bright, and E is then the reference's own */
    json = compare(REFERENCE, FACES);
    is(json, "error", "power", 0.4 / 7.6);
    is(json, "error", "linf", 0.2 / 2.2);
    json_decref(json);
    /* equal tables */
    json = compare(FACES, FACES);
    is(json, "error", "l1_faces", 0);
    ck_assert(json_is_null(json_object_get(json, "noise")));
    json_decref(json);
    ck_assert_ptr_nonnull(strstr(text_of("out"), "does not say how exact it is"));
}
END_TEST

/* Two-sided faces, whose area a reference counts twice; three bands; a sample with gaps. */
START_TEST(bands_sides_samples)
{
    json_t *json = compare("face,area,E_0,E_1,E_2,B_0,B_1,B_2\n0,1,0,0,0,9,9,9\n"
                           "1,1,0,0,0,1.1,2,3\n3,1,1,1,1,1,2,6\n",
                           "face,area,B_0,B_1,B_2,se_0,se_1,se_2\n1,2,1,2,3,.1,.1,.1\n"
                           "3,1,1,2,4,.5,.1,.5\n");
    is(json, NULL, "faces", 3);
    is(json, NULL, "compared", 2);
    is(json, NULL, "reflected_watts", 2 * 6 + 0 + 1 + 3);
    is(json, "error", "power", (2 * 0.1 + 2) / 16);
    is(json, "error", "linf", 2. / 3);
    const json_t *bands = json_object_get(json, "bands");
    ck_assert_uint_eq(json_array_size(bands), 3);
    is(json_array_get(bands, 0), NULL, "power", 0.1);
    is(json_array_get(bands, 1), NULL, "l1_faces", 0);
    is(json_array_get(bands, 2), NULL, "l1_faces", 2. / 9);
    is(json_array_get(bands, 2), NULL, "l2", sqrt(4. / 27));
    json_decref(json);
    ck_assert_ptr_nonnull(strstr(text_of("out"), "2 faces of 3, those in the reference"));
    ck_assert_ptr_nonnull(strstr(text_of("out"), "+4.0\n"));
}
END_TEST

/* Tables of two solves say how many sides there are: light leaves both, also where one table counts
 * one. A byte order mark, which spreadsheets write, is no part of the first column's name. */
START_TEST(sides_of_solves)
{
    static const char *const solve =
        "\xef\xbb\xbf"
        "face,area,E_0,B_0,err_0,se_0,sides\n0,1,0,2,0,0,2\n1,4,0,1,0,0,1\n";
    static const char *const finer =
        "face,area,E_0,B_0,err_0,se_0,sides\n0,1,0,1,0,0,2\n1,4,0,1,0,0,1\n";
    static const char *const of_one_side = "face,area,E_0,B_0\n0,1,0,1\n1,4,0,1\n";
    static const char *const tables[] = {finer, of_one_side};
    for (int i = 0; i < 2; i++) {
        json_t *json = compare(solve, tables[i]);
        is(json, NULL, "reflected_watts", 2 + 4);
        is(json, "error", "power", 2. / 6);
        is(json_array_get(json_object_get(json, "worst"), 0), NULL, "area", 2);
        json_decref(json);
    }
}
END_TEST

/* se_k beside err_k is of the measured error, not of B; of two references both count. */
START_TEST(deviations)
{
    json_t *json =
        compare("face,area,E_0,B_0,err_0,se_0\n0,1,0,2,1,.3\n", "face,area,B_0,se_0\n0,1,1,.4\n");
    is(json, "noise", "power", 0.4);
    json_decref(json);
    json = compare("face,area,E_0,B_0,se_0\n0,1,0,2,.3\n", "face,area,B_0,se_0\n0,1,1,.4\n");
    is(json, "noise", "power", 0.5);
    json_decref(json);
    ck_assert_ptr_nonnull(strstr(text_of("err"), "b.csv: warning: its noise alone"));
    ck_assert_int_eq(run("-q"), 0);
    ck_assert_str_eq(text_of("err"), "");
    ck_assert_str_eq(text_of("out"), "");
}
END_TEST

START_TEST(without_light)
{
    json_t *json = compare("face,area,E_0,B_0\n0,1,5,5\n", "face,area,B_0\n0,1,5\n");
    ck_assert(json_is_null(json_object_get(json_object_get(json, "error"), "power")));
    json_decref(json);
    ck_assert_ptr_nonnull(strstr(text_of("out"), "no light is reflected"));
    ck_assert_ptr_null(strstr(text_of("out"), "nan"));
    /* faces that were dropped have no area */
    json = compare("face,area,E_0,B_0\n0,0,0,0\n1,1,0,1\n", "face,area,B_0\n0,0,3\n1,1,1\n");
    is(json, "error", "linf", 0);
    json_decref(json);
    /* other lamps */
    json = compare("face,area,E_0,B_0\n0,1,5,6\n", "face,area,E_0,B_0\n0,1,4,6\n");
    is(json, "error", "power", 0);
    json_decref(json);
    ck_assert_ptr_nonnull(strstr(text_of("err"), "b.csv:2: warning: face 0 emits 4 W/m2"));
}
END_TEST

START_TEST(bad_tables)
{
    static const char *const rows[][3] = {
        {NULL, REFERENCE, "a.csv: error: cannot read: No such file"},
        {"", REFERENCE, "a.csv:1: error: the columns face, area and B_0 are not all there"},
        {"face,area,E_0,B_0\n", REFERENCE, "a.csv: error: no face is in it"},
        {"face,area,E_0,B_0\n0,1,0\n", REFERENCE, "a.csv:2: error: 3 columns where"},
        {"face,area,E_0,B_0\n0,1,0,x\n", REFERENCE, "a.csv:2: error: 'x' is no radiosity"},
        {"face,area,E_0,B_0\n0,1,0,nan\n", REFERENCE, "a.csv:2: error: 'nan' is no radiosity"},
        {"face,area,E_0,B_0\n0,1,-1,1\n", REFERENCE, "a.csv:2: error: '-1' is no exitance"},
        {"face,area,E_0,B_0\n0,-1,1,1\n", REFERENCE, "a.csv:2: error: '-1' is no area"},
        {"face,area,E_0,B_0\n0,1,1,1\n0,1,1,1\n", REFERENCE, "a.csv:3: error: face '0' is out of"},
        {"face,area,E_0,B_0\n1e99,1,1,1\n", REFERENCE, "a.csv:2: error: face '1e99' is out of"},
        {"face,area,E_0,B_0,sides\n0,1,1,1,3\n", REFERENCE,
         "a.csv:2: error: '3' is no number of sides; write 1 or 2"},
        {FACES, "face,area,B_0,se_0\n0,1,10,-1\n", "b.csv:2: error: '-1' is no standard error"},
        {FACES, "face,area,B_0,B_1\n0,1,10,1\n", "b.csv:1: error: 2 bands of B, but a.csv has 1"},
        {FACES, "face,area,B_0\n0,1,10\n1,2,2\n", "b.csv: error: 2 faces, but a.csv has 3"},
        {FACES, REFERENCE "3,1,1,1\n", "b.csv:5: error: face 3 is not in a.csv, which has 3"},
        {FACES, "face,area,B_0\n0,1,10\n1,3,2\n2,4,1\n",
         "b.csv:3: error: face 1 has 3 m2, but in a.csv 2"},
        {"face,area,B_0\n0,1,1\n", "face,area,B_0\n0,1,1\n", "a.csv:1: error: the column E_0"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        unlink(in_folder("a.csv"));
        if (rows[i][0])
            folder_write("a.csv", rows[i][0]);
        folder_write("b.csv", rows[i][1]);
        ck_assert_int_eq(run("--json none.json"), 1);
        const char *said = text_of("err");
        ck_assert_msg(strncmp(said, rows[i][2], strlen(rows[i][2])) == 0, "row %zu: %s", i, said);
        ck_assert_msg(strchr(said, '\n') == said + strlen(said) - 1, "row %zu: %s", i, said);
        ck_assert_str_eq(text_of("out"), "");
        ck_assert_int_ne(access(in_folder("none.json"), F_OK), 0);
    }
    /* no output over what is read */
    folder_write("a.csv", FACES);
    folder_write("b.csv", REFERENCE);
    ck_assert_int_eq(run("--json b.csv"), 2);
    ck_assert_int_eq(run("--json a.csv"), 2);
    ck_assert_str_eq(text_of("b.csv"), REFERENCE);
}
END_TEST

int main(void)
{
    if (folder_make("error") < 0)
        return 1;
    Suite *suite = suite_create("error");
    TCase *c = tcase_create("error");
    tcase_add_test(c, worked_by_hand);
    tcase_add_test(c, bands_sides_samples);
    tcase_add_test(c, sides_of_solves);
    tcase_add_test(c, deviations);
    tcase_add_test(c, without_light);
    tcase_add_test(c, bad_tables);
    suite_add_tcase(suite, c);
    int failed = suite_failures(suite);
    folder_remove();
    return failed != 0;
}
