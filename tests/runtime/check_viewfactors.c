/* check_viewfactors.c - the command `radiosity viewfactors` against closed forms.
 * Obstructed: two unit squares at distance 1, a quarter of the middle plane blocked, F = 3/4 of the
 * clear value (the example of View3D's manual). A room with a box: every pair of its faces against
 * the contour integral or, where the box stands between, against rays that know nothing of the
 * project's code; formats, closure, open scenes.
 * Once is enough: it is about numbers; that memory is used well, shorter suites tell.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "command.h"
#include "folder.h"
#include "study/closed_forms.h"
#include "runtime/make_pair.h"
#include "runtime/make_room.h"
#include "output/number_text.h"
#include "suite.h"
#include "kernel/polygon_factor.h"

/* Run the command on an OBJ text and read the n x n matrix. */
static void matrix(const char *obj, const char *more, int n, double *f)
{
    folder_write("scene.mtl", "newmtl grey\nKd .5 .5 .5\nnewmtl grey_2s\nKd .5 .5 .5\n");
    folder_write("scene.obj", obj);
    ck_assert_int_eq(
        shell("$RADIOSITY viewfactors %s/scene.obj -q -o %s/out.csv %s", folder, folder, more), 0);
    FILE *in = fopen(in_folder("out.csv"), "r");
    ck_assert_ptr_nonnull(in);
    for (int i = 0; i < n * n; i++)
        ck_assert_int_eq(fscanf(in, i % n == n - 1 ? "%lf\n" : "%lf,", &f[i]), 1);
    ck_assert_int_eq(fgetc(in), EOF);
    fclose(in);
}

START_TEST(test_clear)
{
    double f[4];
    matrix("mtllib scene.mtl\nusemtl grey\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv "
           "1 1 1\nv 0 1 1\n"
           "f 1 2 3 4\nf 8 7 6 5\n",
           "", 2, f);
    ck_assert_double_eq_tol(f[1], 0.1998248956983874, 1e-6);
    ck_assert_double_eq_tol(f[2], 0.1998248956983874, 1e-6);
    ck_assert(f[0] == 0 && f[3] == 0);
    matrix("mtllib scene.mtl\nusemtl grey\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\n"
           "f 1 2 3 4\nf 1 5 6 2\n",
           "", 2, f);
    ck_assert_double_eq_tol(f[1], 0.2000437760754032, 1e-6);
}
END_TEST

START_TEST(test_obstructed)
{
    double f[9];
    matrix("mtllib scene.mtl\nusemtl grey\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv "
           "1 1 1\nv 0 1 1\n"
           "v 0 0 .5\nv .5 0 .5\nv .5 .5 .5\nv 0 .5 .5\nf 1 2 3 4\nf 8 7 6 5\nf 9 10 11 12\n",
           "", 3, f);
    ck_assert_double_eq_tol(f[1] / 0.1498686718, 1, 1e-3);
    ck_assert_double_eq_tol(f[3] / 0.1498686718, 1, 1e-3);
}
END_TEST

#define BOX \
    "mtllib scene.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n" \
    "usemtl grey\nf 4 3 2 1\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"

/* A box with its fronts outside, all of whose faces have two sides, is a room inside: of both
 * sides' light half goes there. One that has a lid of two sides alone sends half of that's up. */
START_TEST(test_two_sided_box)
{
    const double opposite = 0.1998248956983874, beside = 0.2000437760754032;
    double f[49];
    matrix(BOX "f 5 6 7 8\n", "--two-sided", 6, f);
    for (int i = 0; i < 6; i++)
        for (int k = 0; k < 6; k++)
            ck_assert_double_eq_tol(f[6 * i + k],
                                    i == k                              ? 0
                                    : i % 5 == 0 && k % 5 == 0          ? opposite / 2
                                    : i % 5 && k % 5 && abs(i - k) == 2 ? opposite / 2
                                                                        : beside / 2,
                                    1e-6);
    matrix(BOX "usemtl grey_2s\nf 5 6 7 8\nusemtl grey\nv 0 0 2\nv 0 1 2\nv 1 1 2\nv 1 0 2\n"
               "f 9 10 11 12\n",
           "", 7, f);
    ck_assert_double_eq_tol(f[7 * 5 + 6], opposite / 2, 1e-6);
    ck_assert_double_eq_tol(f[7 * 6 + 5], opposite, 1e-6);
    for (int i = 0; i < 5; i++)
        ck_assert(f[7 * i + 5] == 0 && f[7 * 5 + i] == 0);
}
END_TEST

/* Of a duct of 1 x 1 x 16 m, open at both ends, the middle sends .06 % out. That is no error: a
 * closure changes nothing. */
START_TEST(test_far_ways_out)
{
    static const double cut[] = {0, 7, 9, 16};
    enum { ROWS = 12 };
    char obj[4096] = "mtllib scene.mtl\nusemtl grey\n";
    double f[2][ROWS * ROWS], sum = 0;
    for (int i = 0; i < ROWS; i++) {
        const double a = cut[i / 4], b = cut[i / 4 + 1];
        const int y[2] = {i % 4 == 1 || i % 4 == 2, i % 4 == 2 || i % 4 == 3},
                  z[2] = {i % 4 == 2 || i % 4 == 3, i % 4 == 3 || i % 4 == 0};
        const size_t at = strlen(obj);
        snprintf(obj + at, sizeof obj - at,
                 "v %g %d %d\nv %g %d %d\nv %g %d %d\nv %g %d %d\nf -1 -2 -3 -4\n", a, y[0], z[0],
                 b, y[0], z[0], b, y[1], z[1], a, y[1], z[1]);
    }
    matrix(obj, "", ROWS, f[0]);
    matrix(obj, "--closure rows", ROWS, f[1]);
    for (int i = 0; i < ROWS * ROWS; i++)
        ck_assert_double_eq_tol(f[1][i], f[0][i], 1e-9);
    for (int k = 0; k < ROWS; k++)
        sum += f[0][ROWS * 4 + k];
    ck_assert_double_lt(sum, 0.9996);
    ck_assert_double_gt(sum, 0.9990);
}
END_TEST

/* Every row of a closed room is 1; reciprocity holds. */
START_TEST(test_rows)
{
    enum { N = 96 };
    static double f[N * N];
    ck_assert_int_eq(
        shell("$RADIOSITY viewfactors examples/scenes/furnace_4.obj -q -o %s/out.csv", folder), 0);
    FILE *in = fopen(in_folder("out.csv"), "r");
    ck_assert_ptr_nonnull(in);
    for (int i = 0; i < N * N; i++)
        ck_assert_int_eq(fscanf(in, i % N == N - 1 ? "%lf\n" : "%lf,", &f[i]), 1);
    fclose(in);
    for (int i = 0; i < N; i++) {
        double sum = 0;
        for (int j = 0; j < N; j++) {
            sum += f[i * N + j];
            ck_assert_double_eq_tol(f[i * N + j], f[j * N + i], 1e-9);
        }
        ck_assert_double_eq_tol(sum, 1, 1e-6);
    }
}
END_TEST

/* ---- rooms of make_room.h */

static const char *run_room(const struct room *r, int without, const char *more)
{
    folder_write("room.mtl", "newmtl wall\nKd .5 .5 .5\nnewmtl box\nKd .5 .5 .5\n");
    FILE *out = fopen(in_folder("room.obj"), "w");
    ck_assert_ptr_nonnull(out);
    room_write(r, without, out);
    ck_assert_int_eq(fclose(out), 0);
    ck_assert_int_eq(shell("cd %s && $RADIOSITY viewfactors room.obj -q --json out.json -o out %s",
                           folder, more),
                     0);
    return in_folder("out");
}

static json_t *read_json(void)
{
    json_t *json = json_load_file(in_folder("out.json"), 0, NULL);
    ck_assert_ptr_nonnull(json);
    return json;
}

/* f[n * n] from a sparse file with its numbers from `base`, after its head. Returns how many
 * entries. */
static long read_entries(FILE *in, int n, int base, const char *form, double *f)
{
    int count = 0;
    memset(f, 0, (size_t)n * (size_t)n * sizeof *f);
    int i, j;
    double x;
    while (fscanf(in, form, &i, &j, &x) == 3) {
        i -= base;
        j -= base;
        ck_assert(i >= 0 && j >= 0 && i < n && j < n && x > 0 && x <= 1);
        ck_assert(!(f[i * n + j] > 0));
        f[i * n + j] = x;
        count++;
    }
    ck_assert(feof(in));
    fclose(in);
    return count;
}

static double *room_matrix(const struct room *r, int without, const char *more)
{
    int n = without < 0 ? r->faces : r->faces - r->side[without].cuts * r->side[without].cuts;
    double *f = malloc((size_t)n * (size_t)n * sizeof *f);
    char options[256];
    snprintf(options, sizeof options, "--format coo %s", more);
    FILE *in = fopen(run_room(r, without, options), "r");
    ck_assert_ptr_nonnull(f);
    ck_assert_ptr_nonnull(in);
    (void)read_entries(in, n, 0, "%d,%d,%lf", f);
    return f;
}

/* How far A_i F_ij is from A_j F_ji, relative; 1 when only one way is 0. Areas are those of
 * corners rounded to floats, right to 5e-7. */
static double uneven(const struct room *r, const double *f)
{
    int n = r->faces;
    double most = 0, *area = malloc((size_t)n * sizeof *area);
    for (int i = 0; i < n; i++)
        area[i] = room_area(r, i);
    for (int i = 0; i < n; i++)
        for (int j = 0; j < i; j++) {
            double there = area[i] * f[i * n + j], back = area[j] * f[j * n + i];
            if (there > 0 || back > 0)
                most = fmax(most, fabs(there - back) / fmax(there, back));
        }
    free(area);
    return most;
}

/* The same to all digits, without areas: there are any that fit when F_ij F_jk F_ki = F_ik F_kj
 * F_ji [Kolmogorov 1936]. */
static double uneven_cycles(const double *f, int n)
{
    double most = 0;
    uint64_t state = 7;
    for (int t = 0; t < 200000; t++) {
        int a = (int)(room_random(&state) * n), b = (int)(room_random(&state) * n),
            c = (int)(room_random(&state) * n);
        double there = f[a * n + b] * f[b * n + c] * f[c * n + a],
               back = f[a * n + c] * f[c * n + b] * f[b * n + a];
        if (there > 0)
            most = fmax(most, fabs(back / there - 1));
    }
    return most;
}

/* The same numbers in all formats, and as many as the file says; a name per row. */
START_TEST(test_formats)
{
    char line[256], options[300];
    int names = 0;
    struct room r;
    room_make(&r, 3, 2, 20);
    int n = r.faces;
    double *csv;
    csv = malloc((size_t)n * (size_t)n * sizeof *csv);
    double *mtx;
    mtx = malloc((size_t)n * (size_t)n * sizeof *mtx);
    double *coo = room_matrix(&r, -1, "");
    FILE *in = fopen(run_room(&r, -1, "--format csv"), "r");
    for (int i = 0; i < n * n; i++)
        ck_assert_int_eq(fscanf(in, i % n == n - 1 ? "%lf\n" : "%lf,", &csv[i]), 1);
    ck_assert_int_eq(fgetc(in), EOF);
    fclose(in);
    in = fopen(run_room(&r, -1, "--format mtx --names names"), "r");
    ck_assert_ptr_nonnull(fgets(line, sizeof line, in));
    ck_assert_str_eq(line, "%%MatrixMarket matrix coordinate real general\n");
    do
        ck_assert_ptr_nonnull(fgets(line, sizeof line, in));
    while (*line == '%');
    int rows, columns, entries;
    ck_assert_int_eq(sscanf(line, "%d %d %d", &rows, &columns, &entries), 3);
    ck_assert(rows == n && columns == n);
    ck_assert_int_eq(read_entries(in, n, 1, "%d %d %lf", mtx), entries);
    ck_assert_int_eq(memcmp(csv, coo, (size_t)n * (size_t)n * sizeof *csv), 0);
    ck_assert_int_eq(memcmp(mtx, coo, (size_t)n * (size_t)n * sizeof *csv), 0);
    in = fopen(in_folder("names"), "r");
    while (fgets(line, sizeof line, in)) {
        snprintf(options, sizeof options, "%s.%d\n", names < 54 ? "wall" : "box", names);
        ck_assert_str_eq(line, options);
        names++;
    }
    fclose(in);
    ck_assert_int_eq(names, n);
    free(csv);
    free(coo);
    free(mtx);
}
END_TEST

/* Without a box: all of 6 x 144 faces' pairs (short: 6 x 121) against the contour integral; pairs
 * of one wall are 0 to the bit; walls as wholes against closed forms. */
START_TEST(test_empty_room)
{
    double worst = 0, relative = 0, sum[3] = {0, 0, 0};
    struct room r;
    int n = thorough() ? 12 : 11;
    room_make(&r, n, 0, 0);
    double *f = room_matrix(&r, -1, "");
    for (int i = 0; i < r.faces; i++)
        for (int j = 0; j < r.faces; j++) {
            const struct room_side *s = room_side_of(&r, i), *t = room_side_of(&r, j);
            double e = room_area(&r, i) * f[i * r.faces + j];
            ck_assert(s != t || (f[i * r.faces + j] >= 0 && f[i * r.faces + j] <= 0));
            /* the floor against the ceiling, and walls 3 m high and 4 or 5 m long */
            if (s == &r.side[0] && t != s)
                sum[t == &r.side[1] ? 0 : t == &r.side[2] || t == &r.side[3] ? 1 : 2] += e;
            if ((i * 7 + j) % 13 || j <= i)
                continue;
            if (s != t) {
                double p[2][4][3];
                static const int corner[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
                for (int k = 0; k < 4; k++) {
                    int c = i - s->first, d = j - t->first;
                    room_corner(s, c % n + corner[k][0], c / n + corner[k][1], p[0][k]);
                    room_corner(t, d % n + corner[k][0], d / n + corner[k][1], p[1][k]);
                }
                struct two two;
                two_start(&two);
                made_face(&two.scene, 0, 4, (const double(*)[3])p[0]);
                made_face(&two.scene, 0, 4, (const double(*)[3])p[1]);
                two_open(&two);
                double exact = polygon_factor(two.a, two.b, 1);
                two_close(&two);
                worst = fmax(worst, fabs(f[i * r.faces + j] - exact));
                relative = fmax(relative, fabs(f[i * r.faces + j] / exact - 1));
            }
        }
    printf("empty room: error of F %.1e at the most, relative %.1e\n", worst, relative);
    ck_assert_double_lt(worst, 2e-5);
    ck_assert_double_lt(relative, 5e-3);
    ck_assert_double_eq_tol(sum[0] / 20, closed_parallel(4, 5, 3), 1e-5);
    ck_assert_double_eq_tol(sum[1] / 40, closed_perpendicular(4, 3, 5), 1e-4);
    ck_assert_double_eq_tol(sum[2] / 40, closed_perpendicular(5, 3, 4), 1e-4);
    free(f);
}
END_TEST

/* With a box, straight and turned: rows sum to 1 to the tolerance, nothing exceeds 1, both ways
 * round are one number; rows of all kinds of faces are what 150,000 rays say. A right row fails by
 * chance once in 10^6 times; the rays are always the same. */
START_TEST(test_box_in_room)
{
    static const int rows[] = {0, 27, 36, 100, 200, 300, 384, 389, 400, 407};
    struct room r;
    room_make(&r, 8, 2, _i * 30);
    double *f = room_matrix(&r, -1, "");
    for (int i = 0; i < r.faces; i++) {
        double sum = 0;
        for (int j = 0; j < r.faces; j++)
            sum += f[i * r.faces + j];
        ck_assert_double_eq_tol(sum, 1, 1.5e-3);
    }
    ck_assert_double_lt(uneven(&r, f), 1e-6);
    ck_assert_double_lt(uneven_cycles(f, r.faces), 3.1e-11); /* six numbers of twelve digits */
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k += thorough() ? 1 : 2) {
        long hits[408] = {0};
        ck_assert_int_eq(room_rays(&r, rows[k], 150000, (uint64_t)rows[k], hits), 0);
        double worst;
        double chi = room_chi(&r, f + rows[k] * r.faces, hits, 150000, &worst);
        printf("turned by %d, face %d: chi-square %+.2f deviations off, one entry %.2f\n", _i * 30,
               rows[k], chi, worst);
        ck_assert_double_lt(chi, 4.75);
    }
    free(f);
}
END_TEST

/* The rays find a wrong row. */
START_TEST(test_rays_see_errors)
{
    long hits[408] = {0};
    struct room r;
    room_make(&r, 8, 2, 30);
    double *f = room_matrix(&r, -1, "");
    (void)room_rays(&r, 27, 150000, 27, hits);
    for (int j = 0; j < r.faces; j++)
        f[27 * r.faces + j] *= j % 2 ? 1.06 : 0.94;
    double worst;
    ck_assert_double_gt(room_chi(&r, f + 27 * r.faces, hits, 150000, &worst), 4.75);
    free(f);
}
END_TEST

/* Closure of a closed room: rows sum to 1; `reciprocal` keeps the two ways round one number,
 * `rows` does not. */
START_TEST(test_closure)
{
    static const char *const kinds[] = {"--tolerance 0.5 --closure rows",
                                        "--tolerance 0.5 --closure reciprocal"};
    struct room r;
    room_make(&r, 5, 2, 30);
    double *f = room_matrix(&r, -1, kinds[_i]);
    json_t *json = read_json();
    ck_assert_double_gt(json_number_value(json_object_get(json, "row_defect_largest")),
                        1e-5); /* before closure */
    json_decref(json);
    for (int i = 0; i < r.faces; i++) {
        double sum = 0;
        for (int j = 0; j < r.faces; j++)
            sum += f[i * r.faces + j];
        ck_assert_double_eq_tol(sum, 1, 1e-10);
    }
    ck_assert_double_lt(uneven_cycles(f, r.faces), 3.1e-11); /* a factor per row leaves that */
    if (_i)
        ck_assert_double_lt(uneven(&r, f), 1e-6);
    else
        ck_assert_double_gt(uneven(&r, f), 1e-5);
    free(f);
}
END_TEST

/* A room without its ceiling: closure gives nothing of the sky away, and the report says how
 * much there is. */
START_TEST(test_sky)
{
    double *open = NULL, sky = 0, area = 0;
    struct room r;
    room_make(&r, 6, 0, 0);
    double *closed = room_matrix(&r, -1, "");
    int n = r.faces - 36;
    for (int k = 0; k < 2; k++) {
        free(open);
        open = room_matrix(&r, 1, k ? "--closure reciprocal" : "");
        for (int i = 0; i < n; i++) {
            int a = i < 36 ? i : i + 36;
            double sum = 0, up = 0;
            for (int j = 0; j < n; j++)
                sum += open[i * n + j];
            for (int j = 36; j < 72; j++)
                up += closed[a * r.faces + j];
            ck_assert_double_eq_tol(sum + up, 1, 1e-4);
            if (k == 0) {
                sky += room_area(&r, a) * up;
                area += room_area(&r, a);
            }
        }
        json_t *json = read_json();
        ck_assert_int_eq((int)json_integer_value(json_object_get(json, "rows_to_sky")), n);
        ck_assert_int_eq((int)json_integer_value(json_object_get(json, "rows_closed")), 0);
        ck_assert_double_eq_tol(json_number_value(json_object_get(json, "to_sky_mean")), sky / area,
                                1e-4);
        json_decref(json);
    }
    free(open);
    free(closed);
}
END_TEST

/* Byte for byte the same by one thread and two. */
START_TEST(test_threads)
{
    struct room r;
    room_make(&r, 6, 2, 30);
    (void)run_room(&r, -1, "--format coo --threads 1");
    ck_assert_int_eq(rename(in_folder("out"), in_folder("one")), 0);
    (void)run_room(&r, -1, "--format coo --threads 2");
    ck_assert_int_eq(shell("cmp %s/out %s/one", folder, folder), 0);
}
END_TEST

static void compare_text(double x)
{
    char text[NUMBER_TEXT + 1], right[64];
    int n = number_text(text, x);
    text[n] = '\0';
    snprintf(right, sizeof right, "%.12g", x);
    ck_assert_str_eq(text, right);
}

/* The fast text of a number is printf's, for numbers of all sizes, halves between two texts and
 * their neighbours. */
START_TEST(test_number_text)
{
    static const double known[] = {0,
                                   1,
                                   0.5,
                                   1e-4,
                                   9.9999999999949e-5,
                                   9.99999999999501e-5,
                                   999999999999.0,
                                   999999999998.5,
                                   1e-15,
                                   9e-16,
                                   1e12,
                                   1e300,
                                   5e-324,
                                   1 / 3.0,
                                   0.1,
                                   123456.5,
                                   0.0001234567890125};
    uint64_t state = 1;
    for (size_t k = 0; k < sizeof known / sizeof *known; k++)
        compare_text(known[k]);
    for (int i = 0; i < (thorough() ? 100000 : 10000); i++) {
        double x = pow(10, -18 + 34 * room_random(&state)),
               y = ldexp(floor(room_random(&state) * 4096) + 0.5,
                         (int)(room_random(&state) * 40) - 30);
        compare_text(x);
        compare_text(y);
        char tie[64];
        snprintf(tie, sizeof tie, "%.11f5e%d", 1 + 9 * room_random(&state),
                 (int)(room_random(&state) * 26) - 14);
        x = strtod(tie, NULL);
        compare_text(x);
        compare_text(nextafter(x, 0));
        compare_text(nextafter(x, INFINITY));
    }
}
END_TEST

/* What the options say when they are wrong. */
START_TEST(test_options)
{
    static const char *const wrong[] = {"--format xls", "--closure both", "--tolerance 0",
                                        "--names"};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++)
        ck_assert_int_eq(shell("$RADIOSITY viewfactors examples/scenes/furnace.obj %s 2>%s/said",
                               wrong[k], folder),
                         2);
    ck_assert_int_eq(
        shell("$RADIOSITY solve examples/scenes/furnace.obj --closure reciprocal 2>%s/said",
              folder),
        2);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("view factors");
    TCase *c = tcase_create("view factors");
    if (folder_make("viewfactors") < 0)
        return 1;
    tcase_set_timeout(c, 120);
    tcase_add_test(c, test_clear);
    tcase_add_test(c, test_obstructed);
    tcase_add_test(c, test_two_sided_box);
    tcase_add_test(c, test_far_ways_out);
    tcase_add_test(c, test_rows);
    tcase_add_test(c, test_formats);
    tcase_add_test(c, test_empty_room);
    tcase_add_loop_test(c, test_box_in_room, 0, 2);
    tcase_add_test(c, test_rays_see_errors);
    tcase_add_loop_test(c, test_closure, 0, 2);
    tcase_add_test(c, test_sky);
    tcase_add_test(c, test_threads);
    tcase_add_test(c, test_number_text);
    tcase_add_test(c, test_options);
    suite_add_tcase(suite, c);
    int failed = suite_failures(suite);
    folder_remove();
    return failed != 0;
}
