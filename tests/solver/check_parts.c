/* check_parts.c - `radiosity viewfactors` where a part stands for the whole, where points see, and
 * where only products are wanted: --mirror, --repeat, --sensor, --product.
 *
 * Half a box and a mirror are the whole box, whose factors are Howell's C-11 and C-14; a plate
 * repeated is a strip without end, by crossed strings; copies written out are copies made.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "command.h"
#include "folder.h"
#include "study/closed_forms.h"
#include "suite.h"

/* Run the command on a scene of the folder. Returns its exit status; what it says is in `err`. */
static int run(const char *scene, const char *options)
{
    folder_write("grey.mtl", "newmtl grey\nKd .5 .5 .5\n");
    return shell("cd %s && $RADIOSITY viewfactors %s -q -o out.csv %s 2>err", folder, scene,
                 options);
}

static int said(const char *text)
{
    char all[4096] = "";
    FILE *f = fopen(in_folder("err"), "r");
    ck_assert_ptr_nonnull(f);
    all[fread(all, 1, sizeof all - 1, f)] = 0;
    fclose(f);
    return strstr(all, text) != NULL;
}

/* rows x columns numbers of out.csv, after `skip` lines; of each line after its first comma when
 * there is a name. */
static void read_table(int skip, int named, int rows, int columns, double *f)
{
    static char line[1 << 16];
    FILE *in = fopen(in_folder("out.csv"), "r");
    ck_assert_ptr_nonnull(in);
    for (int i = 0; i < skip; i++)
        ck_assert_ptr_nonnull(fgets(line, sizeof line, in));
    for (int i = 0; i < rows; i++) {
        char *at = fgets(line, sizeof line, in), *end;
        ck_assert_ptr_nonnull(at);
        if (named)
            at = strchr(at, ',') + 1;
        for (int j = 0; j < columns; j++, at = end + 1) {
            f[i * columns + j] = strtod(at, &end);
            ck_assert(end > at && *end == (j == columns - 1 ? '\n' : ','));
        }
    }
    ck_assert_int_eq(fgetc(in), EOF);
    fclose(in);
}

/* Half of a box of 2 x 2 x 1.5 m, open at x = 0: floor, ceiling, walls at x = 1, y = 0, y = 2. */
static const char half[] = "mtllib grey.mtl\nusemtl grey\nv 0 0 0\nv 1 0 0\nv 1 2 0\nv 0 2 0\n"
                           "v 0 0 1.5\nv 1 0 1.5\nv 1 2 1.5\nv 0 2 1.5\n"
                           "f 1 2 3 4\nf 8 7 6 5\nf 2 6 7 3\nf 1 5 6 2\nf 3 7 8 4\n";

START_TEST(test_mirror)
{
    double f[25], sum = 0;
    folder_write("half.obj", half);
    ck_assert_int_eq(run("half.obj", "--mirror x=0"), 0);
    read_table(0, 0, 5, 5, f);
    double across = closed_parallel(2, 2, 1.5);
    ck_assert_double_eq_tol(f[1], across, 1e-5);
    ck_assert_double_eq_tol(f[5], across, 1e-5);
    for (int i = 2; i < 5; i++) { /* a wall's image at x = -1 counts as the wall */
        ck_assert_double_eq_tol(f[5 * i], closed_perpendicular(1.5, 2, 2), 1e-5);
        ck_assert_double_eq_tol(f[i], closed_perpendicular(2, 1.5, 2) * (i == 2 ? 2 : 1), 1e-5);
    }
    for (int i = 0; i < 5; i++, sum = 0) {
        for (int j = 0; j < 5; j++)
            sum += f[5 * i + j];
        ck_assert_double_eq_tol(sum, 1, 1e-4);
    }
}
END_TEST

/* The copies that the command makes, written out: the same matrix, summed. */
START_TEST(test_written_out)
{
    enum { N = 6, ALL = 3 * N };
    static const char *const part =
        "v 0 0 0\nv 1 0 0\nv 1 2 0\nv 0 2 0\nv 0 0 1\nv 1 0 1\nv .2 .2 .4\nv .7 .3 .5\n"
        "v .5 1.5 .6\nv 1 2 1\nv 0 2 1\nv 0 1 .5\n";
    static const int faces[N][5] = {{1, 2, 3, 4, 0}, {1, 5, 6, 2, 0},   {7, 8, 9, 0, 0},
                                    {9, 8, 7, 0, 0}, {4, 3, 10, 11, 0}, {5, 12, 7, 0, 0}};
    double f[N * N], whole[ALL * ALL];
    char text[8192], *at;
    for (int copies = 1; copies <= 3; copies += 2) {
        at = text + sprintf(text, "mtllib grey.mtl\nusemtl grey\n");
        for (int c = 0; c < copies; c++) {
            const char *from = part;
            double p[3];
            for (int used; sscanf(from, "v %lf %lf %lf\n%n", &p[0], &p[1], &p[2], &used) == 3;
                 from += used)
                at += sprintf(at, "v %.17g %.17g %.17g\n", p[0],
                              p[1]
                                  + (c == 1 ? -2.5
                                     : c    ? 2.5
                                            : 0),
                              p[2]);
            for (int i = 0; i < N; i++) {
                at += sprintf(at, "f");
                for (int k = 0; faces[i][k]; k++)
                    at += sprintf(at, " %d", faces[i][k] + 12 * c);
                at += sprintf(at, "\n");
            }
        }
        folder_write(copies == 1 ? "part.obj" : "whole.obj", text);
    }
    ck_assert_int_eq(run("whole.obj", ""), 0);
    read_table(0, 0, ALL, ALL, whole);
    ck_assert_int_eq(run("part.obj", "--repeat y=2.5:1 --closure rows"), 0);
    ck_assert_int_eq(run("part.obj", "--repeat y=2.5:1"), 0);
    read_table(0, 0, N, N, f);
    for (int i = 0; i < N; i++)
        for (int j = 0; j < N; j++)
            ck_assert_double_eq_tol(
                f[N * i + j],
                whole[ALL * i + j] + whole[ALL * i + j + N] + whole[ALL * i + j + 2 * N], 1e-11);
}
END_TEST

/* Unit plates at distance 1, repeated along x: strips. What is missing beyond the last copy falls
 * with the square of their number. */
START_TEST(test_repeat)
{
    double f[4];
    folder_write("plates.obj", "mtllib grey.mtl\nusemtl grey\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
                               "v 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nf 1 2 3 4\nf 8 7 6 5\n");
    ck_assert_int_eq(run("plates.obj", "--repeat x=1:30"), 0);
    read_table(0, 0, 2, 2, f);
    ck_assert_double_eq_tol(f[1], sqrt(2) - 1, 4e-4);
    ck_assert_double_eq_tol(f[2], sqrt(2) - 1, 4e-4);
    ck_assert(f[0] == 0 && f[3] == 0);
}
END_TEST

START_TEST(test_sensors)
{
    double row[3 * 7];
    folder_write("half.obj", half);
    folder_write("eyes", "# x y z nx ny nz name\n0 1 .75  0 0 1 mid, up # on the mirror\n\n"
                         ".5 .5 .5 0 0 -2\n.9 1 1 -1 0 0 left\n");
    ck_assert_int_eq(run("half.obj", "--sensor eyes --mirror x=0"), 0);
    read_table(1, 1, 3, 7, row);
    for (int i = 0; i < 3; i++) {
        double sum = 0;
        for (int j = 2; j < 7; j++)
            sum += row[7 * i + j];
        ck_assert_double_eq_tol(sum, 1, 1e-10);
        ck_assert(row[7 * i] < 1e-10 && row[7 * i + 1] < 1e-10);
    }
    /* a square of 2 x 2, .75 over its middle: Howell B-3 */
    double x = 1 / .75, p = sqrt(1 + x * x);
    ck_assert_double_eq_tol(row[3], 4 * (2 * x / p * atan(x / p)) / (2 * (double)CLOSED_PI), 1e-11);
    ck_assert_int_eq(run("half.obj", "--sensor eyes"), 0); /* the open side */
    read_table(1, 1, 3, 7, row);
    ck_assert_double_eq_tol(row[0], 0.5, 1e-11);
    FILE *in = fopen(in_folder("out.csv"), "r");
    char line[256];
    ck_assert(fgets(line, sizeof line, in) && strcmp(line, "name,sky,back,0,1,2,3,4\n") == 0);
    ck_assert(fgets(line, sizeof line, in) && strncmp(line, "mid  up,", 8) == 0);
    ck_assert(fgets(line, sizeof line, in) && strncmp(line, "1,", 2) == 0);
    fclose(in);
}
END_TEST

START_TEST(test_product)
{
    double f[25], x[10], y[10];
    char text[512] = "flux, one # two columns\n", *at = text + strlen(text);
    folder_write("half.obj", half);
    for (int i = 0; i < 5; i++) {
        x[2 * i] = 1.5 - i * i;
        x[2 * i + 1] = 1;
        at += sprintf(at, "%.17g,%.17g\n", x[2 * i], x[2 * i + 1]);
    }
    folder_write("x", text);
    static const char *const how[] = {"", "--mirror x=0 --closure rows --threads 1"};
    for (int h = 0; h < 2; h++) {
        char options[128];
        ck_assert_int_eq(run("half.obj", how[h]), 0);
        read_table(0, 0, 5, 5, f);
        snprintf(options, sizeof options, "%s --product x", how[h]);
        ck_assert_int_eq(run("half.obj", options), 0);
        read_table(1, 0, 5, 2, y);
        for (int i = 0; i < 5; i++)
            for (int c = 0; c < 2; c++) {
                double sum = 0;
                for (int j = 0; j < 5; j++)
                    sum += f[5 * i + j] * x[2 * j + c];
                ck_assert_double_eq_tol(sum, y[2 * i + c], 1e-10);
            }
    }
}
END_TEST

/* What is wrong is said with file and line, and nothing is written. */
START_TEST(test_wrong)
{
    static const struct {
        const char *options, *says;
        int status;
    } cases[] = {
        {"--mirror x", "--mirror takes AXIS=X", 2},
        {"--mirror w=1", "--mirror takes AXIS=X", 2},
        {"--mirror x=1e", "--mirror takes AXIS=X", 2},
        {"--mirror x=nan", "--mirror takes AXIS=X", 2},
        {"--repeat x=0:2", "--repeat takes AXIS=X:N", 2},
        {"--repeat x=1:0", "--repeat takes AXIS=X:N", 2},
        {"--repeat x=1", "--repeat takes AXIS=X:N", 2},
        {"--mirror x=0 --closure reciprocal", "does not go with --mirror", 2},
        {"--sensor eyes --format coo", "does not go with --format", 2},
        {"--product eyes --sensor eyes", "does not go with --sensor", 2},
        {"--product eyes --closure reciprocal", "does not go with --product", 2},
        {"--mirror x=.5", "half.obj:11: error: face 0 crosses the mirror x=0.5", 1},
        {"--mirror x=1", "half.obj:13: error: face 2 lies in the mirror x=1", 1},
        {"--repeat y=1.5:1", "half.obj: error: the scene is 2 m long in y, more than its", 1},
        {"--repeat y=1e9:1 --repeat x=9:1000 --repeat z=9:1000 --mirror x=-1e6 --repeat x=1e8:99",
         "too many; repeat less", 1},
        {"--sensor none", "none: error: cannot read", 1},
        {"--sensor empty", "empty: error: there is no sensor in it", 1},
        {"--sensor short", "short:2: error: a sensor has 6 numbers", 1},
        {"--sensor text", "text:1: error: 'up' is not a finite number", 1},
        {"--sensor zero", "zero:1: error: the direction 0 0 0 looks nowhere", 1},
        {"--product none", "none: error: cannot read", 1},
        {"--product short", "short:2: error: 1 numbers, but 6 in the lines before", 1},
        {"--product zero", "zero: error: 1 lines of numbers, but the scene has 5 faces", 1},
        {"--product words", "words:2: error: 'b' is not a number", 1},
    };
    folder_write("half.obj", half);
    folder_write("eyes", "0 0 0 0 0 1\n");
    folder_write("empty", "# nothing\n");
    folder_write("short", "0 0 0 0 0 1\n1\n");
    folder_write("text", "0 0 up 0 0 1\n");
    folder_write("zero", "1 1 1 0 0 0\n");
    folder_write("words", "a\nb\n");
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        remove(in_folder("out.csv"));
        int status = run("half.obj", cases[i].options);
        ck_assert_msg(status == cases[i].status && said(cases[i].says), "%s: %d, not said: %s",
                      cases[i].options, status, cases[i].says);
        ck_assert_ptr_null(fopen(in_folder("out.csv"), "r"));
    }
}
END_TEST

int main(void)
{
    if (folder_make("parts") < 0)
        return 1;
    Suite *suite = suite_create("parts");
    TCase *t = tcase_create("parts");
    tcase_set_timeout(t, 120);
    tcase_add_test(t, test_mirror);
    tcase_add_test(t, test_written_out);
    tcase_add_test(t, test_repeat);
    tcase_add_test(t, test_sensors);
    tcase_add_test(t, test_product);
    tcase_add_test(t, test_wrong);
    suite_add_tcase(suite, t);
    int failed = suite_failures(suite);
    folder_remove();
    return failed != 0;
}
