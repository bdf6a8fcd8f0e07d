/* check_study_clustering.c - `radiosity study clustering`, run as the user would: its table against
 * solves made one by one.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <jansson.h>
#include "hierarchy/bvh.h"
#include "command.h"
#include "folder.h"
#include "suite.h"

#define SCENE "examples/scenes/furnace_4.obj"
#define HOW "--oracle clusters --set relative=0.4 -q"

/* The exit status; what went to standard error is in folder/log. */
static int run(const char *format, const char *a, const char *b)
{
    char rest[512];
    snprintf(rest, sizeof rest, format, a, b);
    return shell("$RADIOSITY %s 2> %s/log", rest, folder);
}

/* Area-weighted relative L1 of the columns B_0 of two tables that `solve --faces` wrote; all
 * columns before are numbers but the second. */
static double difference(const char *path, const char *reference)
{
    char one[512], two[512];
    FILE *f = fopen(path, "r"), *g = fopen(reference, "r");
    double off = 0, all = 0;
    ck_assert_ptr_nonnull(f);
    ck_assert_ptr_nonnull(g);
    ck_assert(fgets(one, sizeof one, f) && fgets(two, sizeof two, g));
    double area, b, c;
    while (fgets(one, sizeof one, f) && fgets(two, sizeof two, g)) {
        ck_assert_int_eq(sscanf(one, "%*d,%*[^,],%*f,%*f,%*f,%*f,%lf", &b), 1);
        ck_assert_int_eq(sscanf(two, "%*d,%*[^,],%lf,%*f,%*f,%*f,%lf", &area, &c), 2);
        off += area * fabs(b - c);
        all += area * c;
    }
    (void)fclose(f);
    (void)fclose(g);
    return off / all;
}

/* Each row says what `solve --clusters` says of the same strategy; the error is that of its
 * faces against the reference. */
START_TEST(test_table)
{
    ck_assert_int_eq(run("solve " SCENE
                         " --no-correct --oracle bf_guarded --set relative=0.05 -q --faces %s%s",
                         in_folder("reference.csv"), ""),
                     0);
    ck_assert_int_eq(run("study clustering " SCENE " " HOW " --reference %s -o %s",
                         in_folder("reference.csv"), in_folder("table.csv")),
                     0);
    FILE *in = fopen(in_folder("table.csv"), "r");
    ck_assert_ptr_nonnull(in);
    char line[1024];
    ck_assert_ptr_nonnull(fgets(line, sizeof line, in));
    ck_assert(
        strncmp(line, "strategy,clusters,depth,crossed,build_s,cpu_s,clock_s,elements,links,", 69)
        == 0);
    for (int i = 0; i < CLUSTERING_COUNT; i++) {
        char name[32], more[128];
        ck_assert_ptr_nonnull(fgets(line, sizeof line, in));
        unsigned long long elements, links, groups, pairs, rays;
        double crossed, memory, imbalance, error;
        unsigned clusters, depth;
        int converged;
        ck_assert_int_eq(
            sscanf(line, "%31[^,],%u,%u,%lf,%*f,%*f,%*f,%llu,%llu,%llu,%llu,%llu,%lf,%lf,%lf,%d",
                   name, &clusters, &depth, &crossed, &elements, &links, &groups, &pairs, &rays,
                   &memory, &imbalance, &error, &converged),
            13);
        ck_assert_str_eq(name, clustering_names[i]);
        snprintf(more, sizeof more, "--json %s --faces %s", in_folder("one.json"),
                 in_folder("one.csv"));
        ck_assert_int_eq(run("solve " SCENE " --no-correct --basis constant " HOW
                             " --clusters %s %s",
                             name, more),
                         0);
        json_t *json = json_load_file(in_folder("one.json"), 0, NULL);
        ck_assert_ptr_nonnull(json);
        ck_assert_uint_eq(
            elements, (unsigned long long)json_integer_value(json_object_get(json, "elements")));
        ck_assert_uint_eq(links,
                          (unsigned long long)json_integer_value(json_object_get(json, "links")));
        ck_assert_uint_eq(pairs,
                          (unsigned long long)json_integer_value(json_object_get(json, "pairs")));
        ck_assert_uint_eq(rays,
                          (unsigned long long)json_integer_value(json_object_get(json, "rays")));
        ck_assert_double_eq_tol(imbalance,
                                json_real_value(json_object_get(json, "power_imbalance")), 1e-8);
        json_decref(json);
        double alone = difference(in_folder("one.csv"), in_folder("reference.csv"));
        ck_assert_double_gt(alone, 0);
        ck_assert_double_eq_tol(error, alone, 1e-6 * alone);
        ck_assert(converged == 1 && groups > 0 && groups < links);
        ck_assert_uint_lt(clusters, 96);
        ck_assert(depth > 2 && depth < 16);
        /* the root at least; none has more surface than the root */
        ck_assert(crossed >= 1 && crossed < clusters);
        ck_assert_double_gt(memory, 1);
    }
    ck_assert_ptr_null(fgets(line, sizeof line, in));
    (void)fclose(in);
}
END_TEST

/* One strategy, markdown and a chart; without a reference no error is told. */
START_TEST(test_outputs)
{
    char line[1024], text[64] = "";
    int rows = 0;
    ck_assert_int_eq(run("study clustering " SCENE " " HOW " --only octree -o %s --chart %s",
                         in_folder("table.md"), in_folder("chart.svg")),
                     0);
    FILE *in = fopen(in_folder("table.md"), "r");
    ck_assert_ptr_nonnull(in);
    while (fgets(line, sizeof line, in))
        if (strncmp(line, "| octree |", 10) == 0) {
            rows++;
            ck_assert_ptr_nonnull(strstr(line, "% | - |"));
        } else {
            ck_assert(strncmp(line, "| ", 2) != 0 || strncmp(line, "| strategy |", 12) == 0);
        }
    (void)fclose(in);
    ck_assert_int_eq(rows, 1);
    in = fopen(in_folder("chart.svg"), "r");
    ck_assert_ptr_nonnull(in);
    ck_assert_uint_gt(fread(text, 1, sizeof text - 1, in), 10);
    ck_assert_ptr_nonnull(strstr(text, "<?xml"));
    (void)fclose(in);
}
END_TEST

/* A table of some of the faces counts those alone: with B a tenth too large for all of the
 * sample, the error is 1/11. */
START_TEST(test_sample)
{
    char line[512], name[8];
    ck_assert_int_eq(run("solve " SCENE " --no-correct --basis constant " HOW
                         " --clusters kd --faces %s%s",
                         in_folder("whole.csv"), ""),
                     0);
    FILE *in = fopen(in_folder("whole.csv"), "r");
    FILE *out = fopen(in_folder("sample.csv"), "w");
    ck_assert(in && out && fgets(line, sizeof line, in));
    fputs("B_0,face,area\n", out);
    double area, b;
    int face;
    for (int n = 0; fgets(line, sizeof line, in); n++) {
        ck_assert_int_eq(sscanf(line, "%d,%*[^,],%lf,%*f,%*f,%*f,%lf", &face, &area, &b), 3);
        if (n % 5 == 2)
            fprintf(out, "%.12g,%d,%.12g\n", 1.1 * b, face, area);
    }
    (void)fclose(in);
    ck_assert_int_eq(fclose(out), 0);
    ck_assert_int_eq(run("study clustering " SCENE " " HOW " --only kd --reference %s -o %s",
                         in_folder("sample.csv"), in_folder("table.csv")),
                     0);
    in = fopen(in_folder("table.csv"), "r");
    ck_assert(in && fgets(line, sizeof line, in) && fgets(line, sizeof line, in));
    (void)fclose(in);
    double error;
    ck_assert_int_eq(sscanf(line, "%7[^,],%*u,%*u,%*f,%*f,%*f,%*f,%*u,%*u,%*u,%*u,%*u,%*f,%*f,%lf",
                            name, &error),
                     2);
    ck_assert_double_eq_tol(error, 0.1 / 1.1, 1e-9);
}
END_TEST

/* What is wrong with a reference is told with its line, before any work. */
START_TEST(test_bad_reference)
{
    static const struct {
        const char *table, *message;
    } bad[] = {
        {"", "bad.csv:1: error"},
        {"face,area\n0,1\n", "bad.csv:1: error"},
        {"face,area,B_0,B_1,B_2\n0,1,1,1,1\n", "bad.csv:1: error"},
        {"face,area,B_0\n7,1,2\n7,1,2\n",
         "bad.csv:3: error: face '7' is out of order, or none of the scene's 96"},
        {"face,area,B_0\n0,1,2\n96,1,2\n", "bad.csv:3: error: face '96' is"},
        {"face,area,B_0\n1.5,1,2\n", "bad.csv:2: error: face '1.5' is"},
        {"face,area,B_0\n0,1,2\n1,1\n", "bad.csv:3: error: 2 columns"},
        {"face,area,B_0\n0,1,two\n", "bad.csv:2: error: 'two'"},
        {"face,area,B_0\n0,-1,2\n", "bad.csv:2: error: '-1'"},
        {"face,area,B_0\n", "bad.csv: error: no face"},
    };
    char log[1024] = "";
    folder_write("bad.csv", bad[_i].table);
    ck_assert_int_eq(run("study clustering " SCENE " " HOW " --reference %s -o %s",
                         in_folder("bad.csv"), in_folder("none.csv")),
                     1);
    FILE *in = fopen(in_folder("log"), "r");
    ck_assert_ptr_nonnull(in);
    ck_assert_ptr_nonnull(fgets(log, sizeof log, in));
    (void)fclose(in);
    ck_assert_msg(strstr(log, bad[_i].message) != NULL, "%s", log);
    ck_assert_int_ne(access(in_folder("none.csv"), F_OK), 0);
}
END_TEST

START_TEST(test_usage)
{
    ck_assert_int_eq(run("study clustering%s%s", "", ""), 2);
    ck_assert_int_eq(run("study clustering " SCENE " -o %s%s", "table.txt", ""), 2);
    ck_assert_int_eq(run("study clustering " SCENE " --only %s%s", "none", ""), 2);
    ck_assert_int_eq(run("study clustering " SCENE " --rays %s%s", "4", ""), 2);
    ck_assert_int_eq(run("study visibility " SCENE " --reference %s%s", "x.csv", ""), 2);
    ck_assert_int_eq(run("solve " SCENE " --clusters %s%s", "none", ""), 2);
    ck_assert_int_eq(run("study clustering " SCENE " --reference %s%s", "missing.csv", ""), 1);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("study clustering");
    TCase *c = tcase_create("study clustering");
    if (folder_make("clustering") < 0)
        return 1;
    tcase_set_timeout(c, 120);
    tcase_add_test(c, test_table);
    tcase_add_test(c, test_outputs);
    tcase_add_test(c, test_sample);
    tcase_add_loop_test(c, test_bad_reference, 0, 10);
    tcase_add_test(c, test_usage);
    suite_add_tcase(suite, c);
    int failed = suite_failures(suite);
    folder_remove();
    return failed != 0;
}
