/* check_points.c - what points see of a scene: closed forms, shadows whose edges are known, sums in
 * closed rooms, and rays that know nothing of the project's code.
 * [rectangles from a point: Howell B-3, B-4; sphere from a point: Howell B-43]
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "radiosity.h"
#include "study/closed_forms.h"
#include "suite.h"

static const double PI = 3.14159265358979323846;
enum { POLYGONS = 40000 };

/* Polygons of three or four corners, none shared. */
struct soup {
    double at[POLYGONS * 4][3];
    uint32_t sizes[POLYGONS], materials[POLYGONS], indices[POLYGONS * 4], count, corners;
};

static void add(struct soup *s, uint32_t material, uint32_t n, const double (*p)[3])
{
    for (uint32_t i = 0; i < n; i++, s->corners++) {
        memcpy(s->at[s->corners], p[i], sizeof *p);
        s->indices[s->corners] = s->corners;
    }
    s->materials[s->count] = material;
    s->sizes[s->count++] = n;
}

/* o, o + a, o + a + b, o + b: its front is where a x b points. */
static void add_quad(struct soup *s, uint32_t material, const double o[3], const double a[3],
                     const double b[3])
{
    double p[4][3];
    for (int k = 0; k < 3; k++) {
        p[0][k] = o[k];
        p[1][k] = o[k] + a[k];
        p[2][k] = o[k] + a[k] + b[k];
        p[3][k] = o[k] + b[k];
    }
    add(s, material, 4, (const double(*)[3])p);
}

/* A closed box of 2 x 3 x 2 m seen from inside. */
static void add_room(struct soup *s)
{
    const double o[3] = {0}, x[3] = {2, 0, 0}, y[3] = {0, 3, 0}, z[3] = {0, 0, 2};
    add_quad(s, 0, o, x, y);
    add_quad(s, 0, z, y, x);
    add_quad(s, 0, o, z, x);
    add_quad(s, 0, y, x, z);
    add_quad(s, 0, o, y, z);
    add_quad(s, 0, x, z, y);
}

static RadDevice device;

static RadScene commit(const struct soup *s)
{
    const struct RadMaterial m[2] = {{.reflectance = {.5, .5, .5}},
                                     {.reflectance = {.5, .5, .5}, .two_sided = 1}};
    const struct RadPolygons p = {.positions = s->at[0],
                                  .position_count = s->corners,
                                  .indices = s->indices,
                                  .sizes = s->sizes,
                                  .materials = s->materials,
                                  .count = s->count};
    RadScene scene = radNewScene(device);
    ck_assert_int_eq(radSetSceneMaterials(scene, m, 2), 0);
    ck_assert_int_eq(radSetSceneSharedPolygons(scene, &p), 0);
    ck_assert_msg(radCommitScene(scene) == 0, "%s", radGetDeviceErrorMessage(device));
    return scene;
}

/* The row of one point of a soup; free(). */
static double *see(const struct soup *s, const double x[3], const double n[3])
{
    RadScene scene = commit(s);
    double *row = malloc((s->count + 2) * sizeof *row), sum = 0;
    ck_assert_int_eq(radGetPointFactors(scene, 1, x, n, row), 0);
    radReleaseScene(scene);
    for (uint32_t i = 0; i < s->count + 2; i++) {
        ck_assert(row[i] >= 0 && row[i] <= 1);
        sum += row[i];
    }
    ck_assert_double_eq_tol(sum, 1, 1e-11);
    return row;
}

static struct soup *soup_new(void)
{
    return calloc(1, sizeof(struct soup));
}

/* One at right angles to it, c away, b wide and a high from the element's plane: B-4. */
static double upright(double a, double b, double c)
{
    double r = sqrt(a * a + c * c);
    return (atan(b / c) - c / r * atan(b / r)) / (2 * PI);
}

START_TEST(test_closed_forms)
{
    static const double up[3] = {0, 0, 1}, along[3] = {7, 0, 0};
    const double o[3] = {0, 0, 2}, a[3] = {0, 1.5, 0}, b[3] = {.5, 0, 0}, x[3] = {0};
    struct soup *s = soup_new();
    add_quad(s, 0, o, a, b);
    double *row = see(s, x, up);
    ck_assert_double_eq_tol(row[0], closed_corner(1.5, .5, 2), 1e-14);
    ck_assert_double_eq_tol(row[1], 1 - row[0], 1e-14);
    free(row);
    /* the same to an element on its side, and from its other side, where the back is black */
    row = see(s, x, along);
    ck_assert_double_eq_tol(row[0], upright(.5, 1.5, 2), 1e-14);
    free(row);
    const double above[3] = {0, 0, 4}, down[3] = {0, 0, -1};
    row = see(s, above, down);
    ck_assert_double_eq_tol(row[2], closed_corner(1.5, .5, 2), 1e-14);
    ck_assert(row[0] == 0);
    free(row);
    s->materials[0] = 1; /* or is not */
    row = see(s, above, down);
    ck_assert_double_eq_tol(row[0], closed_corner(1.5, .5, 2), 1e-14);
    ck_assert(row[2] == 0);
    free(row);
    free(s);
}
END_TEST

/* A plate half way up hides of the ceiling twice its own length and width; one wide enough all of
 * it; one in the ceiling's plane, or under the floor, nothing. */
START_TEST(test_shadows)
{
    static const double up[3] = {0, 0, 1}, x[3] = {0}, o[3] = {0, 0, 2}, a[3] = {0, 1, 0},
                        b[3] = {1, 0, 0};
    const double mid[3] = {.1, .1, 1}, c[3] = {0, .2, 0}, d[3] = {.3, 0, 0};
    struct soup *s = soup_new();
    add_quad(s, 0, o, a, b);
    add_quad(s, 0, mid, c, d);
    double *row = see(s, x, up), hidden = closed_corner(.8, .6, 2) - closed_corner(.2, .6, 2)
                                          - closed_corner(.8, .2, 2) + closed_corner(.2, .2, 2);
    ck_assert_double_eq_tol(row[1], hidden, 1e-14);
    ck_assert_double_eq_tol(row[0], closed_corner(1, 1, 2) - hidden, 1e-14);
    free(row);
    const double wide[3] = {-1, -1, .5}, e[3] = {0, 4, 0}, f[3] = {4, 0, 0};
    add_quad(s, 0, wide, e, f);
    row = see(s, x, up);
    ck_assert(row[0] == 0 && row[1] == 0);
    free(row);
    s->count -= 2;
    s->corners -= 8;
    const double beside[3] = {1, 0, 2}, under[3] = {-1, -1, -.5};
    add_quad(s, 0, beside, a, b);
    add_quad(s, 0, under, e, f);
    row = see(s, x, up);
    ck_assert_double_eq_tol(row[0], closed_corner(1, 1, 2), 1e-14);
    ck_assert_double_eq_tol(row[1], closed_corner(1, 2, 2) - closed_corner(1, 1, 2), 1e-14);
    ck_assert(row[2] == 0);
    free(row);
    s->count -= 2; /* a sheet against the ceiling's back, whose front is the other way */
    s->corners -= 8;
    add_quad(s, 0, o, b, a);
    const double above[3] = {0, 0, 4}, down[3] = {0, 0, -1};
    row = see(s, above, down);
    ck_assert_double_eq_tol(row[1], closed_corner(1, 1, 2), 1e-14);
    ck_assert(row[0] == 0 && row[3] == 0);
    free(row);
    free(s);
}
END_TEST

static double random_number(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) * 0x1p-53;
}

/* Where the ray from x along d meets a convex polygon: its t, or INFINITY. */
static double meets(const double (*p)[3], uint32_t n, const double x[3], const double d[3])
{
    double least = INFINITY;
    for (uint32_t i = 2; i < n; i++) { /* [Moeller and Trumbore 1997] */
        double e[3], f[3], h[3], q[3], w[3];
        for (int k = 0; k < 3; k++) {
            e[k] = p[i - 1][k] - p[0][k];
            f[k] = p[i][k] - p[0][k];
            w[k] = x[k] - p[0][k];
        }
        for (int k = 0; k < 3; k++) {
            h[k] = d[(k + 1) % 3] * f[(k + 2) % 3] - d[(k + 2) % 3] * f[(k + 1) % 3];
            q[k] = w[(k + 1) % 3] * e[(k + 2) % 3] - w[(k + 2) % 3] * e[(k + 1) % 3];
        }
        double det = e[0] * h[0] + e[1] * h[1] + e[2] * h[2];
        double u = (w[0] * h[0] + w[1] * h[1] + w[2] * h[2]) / det,
               v = (d[0] * q[0] + d[1] * q[1] + d[2] * q[2]) / det,
               t = (f[0] * q[0] + f[1] * q[1] + f[2] * q[2]) / det;
        if (u >= 0 && v >= 0 && u + v <= 1 && t > 1e-9 && t < least)
            least = t;
    }
    return least;
}

/* 300 two-sided triangles at random in a closed room: nothing to the sky, and every share as rays
 * say, one in each of 200 x 200 cells of equal weight. */
START_TEST(test_soup)
{
    enum { RAYS = 200 };
    struct soup *s = soup_new();
    uint64_t state = 5;
    add_room(s);
    for (int i = 0; i < 300; i++) {
        double p[3][3], c[3] = {.1 + 1.8 * random_number(&state), .1 + 2.8 * random_number(&state),
                                .2 + 1.6 * random_number(&state)};
        for (int v = 0; v < 3; v++)
            for (int k = 0; k < 3; k++)
                p[v][k] = c[k] + .3 * (random_number(&state) - .5);
        add(s, 1, 3, (const double(*)[3])p);
    }
    const double x[3] = {.9, 1.3, .1}, up[3] = {0, 0, 1};
    double *row = see(s, x, up), *shot = calloc(s->count, sizeof *shot), worst = 0;
    ck_assert(row[s->count] < 1e-12 && row[s->count + 1] < 1e-12);
    for (int i = 0; i < RAYS * RAYS; i++) {
        double z2 = (i / RAYS + random_number(&state)) / RAYS,
               phi = 2 * PI * (i % RAYS + random_number(&state)) / RAYS, least = INFINITY;
        const double d[3] = {sqrt(z2) * cos(phi), sqrt(z2) * sin(phi), sqrt(1 - z2)};
        uint32_t met = 0, at = 0;
        for (uint32_t j = 0; j < s->count; at += s->sizes[j++]) {
            double t = meets((const double(*)[3])s->at + at, s->sizes[j], x, d);
            if (t < least) {
                least = t;
                met = j;
            }
        }
        shot[met] += 1.0 / RAYS / RAYS;
    }
    for (uint32_t j = 0; j < s->count; j++)
        worst = fmax(worst, fabs(shot[j] - row[j]));
    ck_assert_msg(worst < 1.5e-3, "%g", worst);
    free(shot);
    free(row);
    free(s);
}
END_TEST

/* A sheet that may stick out through a wall, from points on the floor: each row sums to 1. */
START_TEST(test_pierced)
{
    uint64_t state = 11;
    for (int i = 0; i < 2000; i++) {
        struct soup *s = soup_new();
        double o[3], a[3], b[3];
        add_room(s);
        for (int k = 0; k < 3; k++) {
            o[k] = (k == 1 ? 3 : 2) * random_number(&state);
            a[k] = 1.5 * (random_number(&state) - .5);
            b[k] = 1.5 * (random_number(&state) - .5);
        }
        add_quad(s, 1, o, a, b);
        const double x[3] = {.1 + 1.8 * random_number(&state), .1 + 2.8 * random_number(&state), 0},
                     up[3] = {0, 0, 1};
        free(see(s, x, up));
        free(s);
    }
}
END_TEST

/* A sphere of 2 * bands * bands triangles and quads, 1 m from the element; seen from inside it, and
 * from outside in front of a wall of one face, which all of them hide. */
START_TEST(test_many)
{
    enum { BANDS = 80 };
    const double x[3] = {0}, up[3] = {0, 0, 1}, o[3] = {-9, -9, 2}, a[3] = {0, 18, 0},
                 b[3] = {18, 0, 0};
    struct soup *s = soup_new();
    add_quad(s, 0, o, a, b);
    for (int i = 0; i < BANDS; i++)
        for (int j = 0; j < 2 * BANDS; j++) {
            double p[4][3];
            for (int v = 0; v < 4; v++) {
                double t = PI * (i + (v == 1 || v == 2)) / BANDS,
                       f = PI * ((j + (v > 1)) % (2 * BANDS)) / BANDS;
                p[v][0] = .2 * sin(t) * cos(f);
                p[v][1] = .2 * sin(t) * sin(f);
                p[v][2] = 1 + .2 * cos(t);
            }
            if (i == 0) /* at the poles two corners are one */
                add(s, 0, 3, (const double(*)[3])p);
            else if (i == BANDS - 1)
                add(s, 0, 3,
                    (const double(*)[3])(double[3][3]){{p[0][0], p[0][1], p[0][2]},
                                                       {p[1][0], p[1][1], p[1][2]},
                                                       {p[3][0], p[3][1], p[3][2]}});
            else
                add(s, 0, 4, (const double(*)[3])p);
        }
    double *row = see(s, x, up), sphere = 0;
    for (uint32_t i = 1; i < s->count; i++)
        sphere += row[i];
    /* its outline from the point: a cone of sine .2, by a polygon a little smaller */
    ck_assert_double_eq_tol(sphere, .04, 2e-4);
    ck_assert_double_eq_tol(row[0], 4 * closed_corner(9, 9, 2) - sphere, 1e-11);
    ck_assert(row[s->count + 1] < 1e-13);
    free(row);
    const double inside[3] = {.05, .03, 1.02}, aside[3] = {1, 2, -.3};
    row = see(s, inside, aside);
    ck_assert_double_eq_tol(row[s->count + 1], 1, 1e-11);
    free(row);
    free(s);
}
END_TEST

/* On a wall, or behind it by rounding: it is neither seen nor hides; and in corners, where half of
 * what is looked at lies outside of the room. Coordinates of a map change nothing but digits. */
START_TEST(test_on_walls)
{
    const double x[3][3] = {{-1e-13, 1, 1}, {0, 0, 0}, {2, 3, .5}},
                 n[3][3] = {{1, 0, 0}, {1, 1, 1}, {-1, -2, .25}};
    struct soup *s = soup_new();
    add_room(s);
    RadScene scene = commit(s);
    double rows[3][8], far_rows[3][8], far_x[3][3];
    ck_assert_int_eq(radGetPointFactors(scene, 3, x[0], n[0], rows[0]), 0);
    radReleaseScene(scene);
    ck_assert_double_eq_tol(rows[0][6], 0, 1e-12);
    ck_assert(rows[1][6] > .5 && rows[1][7] == 0);
    ck_assert(rows[0][4] == 0 && rows[0][7] == 0);
    for (uint32_t i = 0; i < s->corners; i++)
        s->at[i][0] += 4e6;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            far_x[i][k] = x[i][k] + (k == 0 ? 4e6 : 0);
    scene = commit(s);
    ck_assert_int_eq(radGetPointFactors(scene, 3, far_x[0], n[0], far_rows[0]), 0);
    radReleaseScene(scene);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 8; j++)
            ck_assert_double_eq_tol(far_rows[i][j], rows[i][j], 1e-8);
    free(s);
}
END_TEST

START_TEST(test_errors)
{
    const double x[3] = {1, 1, 1}, zero[3] = {0}, up[3] = {0, 0, 1}, bad[3] = {NAN, 0, 0},
                 beyond[3] = {0, 0, 1e300};
    struct soup *s = soup_new();
    add_room(s);
    RadScene scene = commit(s), early = radNewScene(device);
    double row[8];
    ck_assert_int_eq(radGetPointFactors(NULL, 1, x, up, row), -1);
    ck_assert_int_eq(radGetPointFactors(early, 1, x, up, row), -1);
    ck_assert_int_eq(radGetDeviceError(device), RAD_ERROR_INVALID_OPERATION);
    ck_assert_int_eq(radGetPointFactors(scene, 1, x, zero, row), -1);
    ck_assert_int_eq(radGetDeviceError(device), RAD_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(radGetPointFactors(scene, 1, bad, up, row), -1);
    ck_assert_int_eq(radGetPointFactors(scene, 1, beyond, up, row), -1);
    ck_assert_int_eq(radGetPointFactors(scene, 1, x, up, NULL), -1);
    ck_assert_int_eq(radGetPointFactors(scene, 0, NULL, NULL, NULL), 0);
    (void)radGetDeviceError(device);
    radReleaseScene(early);
    radReleaseScene(scene);
    free(s);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("points");
    TCase *t = tcase_create("points");
    device = radNewDevice(NULL);
    tcase_set_timeout(t, 120);
    tcase_add_test(t, test_closed_forms);
    tcase_add_test(t, test_shadows);
    tcase_add_test(t, test_soup);
    tcase_add_test(t, test_pierced);
    tcase_add_test(t, test_many);
    tcase_add_test(t, test_on_walls);
    tcase_add_test(t, test_errors);
    suite_add_tcase(suite, t);
    int failed = suite_failures(suite);
    radReleaseDevice(device);
    return failed != 0;
}
