/* check_viewfactors.c - the command `radiosity viewfactors` against closed forms.
 * Obstructed: two unit squares at distance 1, a quarter of the middle plane blocked, F = 3/4 of the
 * clear value (the example of View3D's manual). Penumbra and corridor rows: sums to one in closed scenes.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char folder[] = "/tmp/viewfactors-XXXXXX";

static void write_file(const char *name, const char *text)
{
    char path[256];
    FILE *f;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    f = fopen(path, "w");
    ck_assert_ptr_nonnull(f);
    fputs(text, f);
    ck_assert_int_eq(fclose(f), 0);
}

/* Run the command on an OBJ text and read the n x n matrix. */
static void matrix(const char *obj, const char *more, int n, double *f)
{
    char command[1024], path[256];
    const char *program = getenv("RADIOSITY");
    FILE *in;
    int i;
    write_file("scene.mtl", "newmtl grey\nKd .5 .5 .5\n");
    write_file("scene.obj", obj);
    snprintf(command, sizeof command, "%s viewfactors %s/scene.obj -q -o %s/out.csv %s", program ? program : "build/bin/radiosity",
             folder, folder, more);
    ck_assert_int_eq(system(command), 0);
    snprintf(path, sizeof path, "%s/out.csv", folder);
    in = fopen(path, "r");
    ck_assert_ptr_nonnull(in);
    for (i = 0; i < n * n; i++)
        ck_assert_int_eq(fscanf(in, i % n == n - 1 ? "%lf\n" : "%lf,", &f[i]), 1);
    ck_assert_int_eq(fgetc(in), EOF);
    fclose(in);
}

START_TEST(test_clear)
{
    double f[4];
    matrix("mtllib scene.mtl\nusemtl grey\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
           "f 1 2 3 4\nf 8 7 6 5\n", "", 2, f);
    ck_assert_double_eq_tol(f[1], 0.1998248956983874, 1e-6);
    ck_assert_double_eq_tol(f[2], 0.1998248956983874, 1e-6);
    ck_assert(f[0] == 0 && f[3] == 0);
    matrix("mtllib scene.mtl\nusemtl grey\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\n"
           "f 1 2 3 4\nf 1 5 6 2\n", "", 2, f);
    ck_assert_double_eq_tol(f[1], 0.2000437760754032, 1e-6);
}
END_TEST

START_TEST(test_obstructed)
{
    double f[9];
    matrix("mtllib scene.mtl\nusemtl grey\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
           "v 0 0 .5\nv .5 0 .5\nv .5 .5 .5\nv 0 .5 .5\nf 1 2 3 4\nf 8 7 6 5\nf 9 10 11 12\n", "", 3, f);
    ck_assert_double_eq_tol(f[1] / 0.1498686718, 1, 1e-3);
    ck_assert_double_eq_tol(f[3] / 0.1498686718, 1, 1e-3);
}
END_TEST

/* Every row of a closed room is 1; reciprocity holds. */
START_TEST(test_rows)
{
    enum { N = 96 };
    static double f[N * N];
    char command[512], path[256];
    const char *program = getenv("RADIOSITY");
    FILE *in;
    int i, j;
    snprintf(path, sizeof path, "%s/out.csv", folder);
    snprintf(command, sizeof command, "%s viewfactors examples/scenes/furnace_4.obj -q -o %s", program ? program : "build/bin/radiosity", path);
    ck_assert_int_eq(system(command), 0);
    in = fopen(path, "r");
    ck_assert_ptr_nonnull(in);
    for (i = 0; i < N * N; i++)
        ck_assert_int_eq(fscanf(in, i % N == N - 1 ? "%lf\n" : "%lf,", &f[i]), 1);
    fclose(in);
    for (i = 0; i < N; i++) {
        double sum = 0;
        for (j = 0; j < N; j++) {
            sum += f[i * N + j];
            ck_assert_double_eq_tol(f[i * N + j], f[j * N + i], 1e-9);
        }
        ck_assert_double_eq_tol(sum, 1, 1e-6);
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("view factors");
    TCase *c = tcase_create("view factors");
    SRunner *runner;
    char command[256];
    int failed;
    if (!mkdtemp(folder))
        return 1;
    tcase_set_timeout(c, 120);
    tcase_add_test(c, test_clear);
    tcase_add_test(c, test_obstructed);
    tcase_add_test(c, test_rows);
    suite_add_tcase(suite, c);
    runner = srunner_create(suite);
    srunner_run_all(runner, CK_NORMAL);
    failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    snprintf(command, sizeof command, "rm -r %s", folder);
    return system(command) != 0 || failed != 0;
}
