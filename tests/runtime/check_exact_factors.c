/* check_exact_factors.c - view factors of narrow and near pairs, by way of the API: plates with
 * gaps from 1e-8 to 1000 of their size, squares hinged at angles from 0.01 to 179 degrees, a narrow
 * strip on a square's edge; as they lie and turned, at scales from 1e-6 to 1e6.
 *
 * What they are held against knows no contours and no logarithm of a distance between edges: of
 * strips that run along z both integrals along z are closed,
 *     int_0^1 int_0^1 dz dz' / (d^2 + (z - z')^2)^2 = atan(1 / d) / d^3,
 * one across is closed, and what is left is smooth in an angle and integrated by tanh-sinh.
 * Once is enough: it is about numbers; that memory is used well, shorter suites tell.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <stdlib.h>
#include "radiosity.h"
#include "suite.h"

#define PI 3.14159265358979323846

/* ---- independent values */

typedef double (*integrand)(double x, double parameter);

/* [Takahasi and Mori 1974] */
static double tanh_sinh(integrand f, double a, double b, double parameter)
{
    const double step = 1 / 32.0;
    double sum = 0;
    for (int i = -128; i <= 128; i++) {
        double t = i * step, u = 0.5 * PI * sinh(t), c = cosh(u), half = 0.5 * (b - a);
        double x = u < 0 ? a + half * exp(u) / c : b - half * exp(-u) / c;
        if (x > a && x < b)
            sum += 0.5 * PI * cosh(t) / (c * c) * f(x, parameter);
    }
    return sum * step * 0.5 * (b - a);
}

/* The same by parts that grow tenfold from a, or where `back`, from b. */
static double integral(integrand f, double a, double b, double parameter, int back)
{
    double sum = 0, from = 0;
    for (double to = 1e-9; from < b - a; to *= 10) {
        to = fmin(to, b - a);
        sum += back ? tanh_sinh(f, b - to, b - from, parameter)
                    : tanh_sinh(f, a + from, a + to, parameter);
        from = to;
    }
    return sum;
}

static double hinge_at(double angle, double phi)
{
    double g = sin(phi) / cos(angle);
    return cos(angle - phi) * (atan(1 / g) + log1p(g * g) / (2 * g));
}

/* Unit squares with a common edge, phi (rad) between them: the ratio of the distances from the edge
 * is cos phi + sin phi tan angle, the mean over one of them is closed. */
static double hinge_factor(double phi)
{
    return 2 / PI * integral(hinge_at, phi - 0.5 * PI, 0.5 * phi, phi, 0);
}

static double plates_at(double angle, double gap)
{
    return (1 - gap * tan(angle)) * cos(angle) * atan(cos(angle) / gap);
}

/* Aligned unit squares: strips are gap tan angle apart sideways. */
static double plates_factor(double gap)
{
    return 2 / PI * integral(plates_at, 0, atan(1 / gap), gap, 1);
}

/* int atan(1 / d) / d^2 dd */
static double across(double d)
{
    return 0.5 * log1p(1 / (d * d)) - atan(1 / d) / d;
}

static double strip_at(double x, double width)
{
    (void)width;
    return x * (across(sqrt(x * x + 1)) - across(x));
}

/* From a strip 1 x width that stands on the edge of a unit square, at a right angle. */
static double strip_factor(double width)
{
    return tanh_sinh(strip_at, 0, width, 0) / (PI * width);
}

/* The sources listed in Howell's catalog, to the digits there. */
START_TEST(test_references)
{
    ck_assert_double_eq_tol(hinge_factor(0.5 * PI), 0.2000437760754032, 1e-14);
    ck_assert_double_eq_tol(strip_factor(1), 0.2000437760754032, 1e-14);
    ck_assert_double_eq_tol(strip_factor(0.1), 0.432513694, 1e-9);
    ck_assert_double_eq_tol(plates_factor(1), 0.1998248956983874, 1e-14);
    ck_assert_double_eq_tol(plates_factor(0.01), 0.9804166029, 1e-10);
    /* narrow: what leaves by the rim, 4 x gap / 2, is missing; crossed strings */
    ck_assert_double_eq_tol(plates_factor(1e-8), 1 - 2e-8, 1e-14);
    ck_assert_double_eq_tol(strip_factor(1e-9), 0.5, 1e-8);
    ck_assert_double_eq_tol(hinge_factor(1e-3), 1 - 1e-3, 1e-4);
}
END_TEST

/* ---- what the library says */

/* The corners in space: turned about two axes if asked to, then scaled. */
static void place(double *p, int count, int turned, double scale)
{
    const double a = turned ? 0.7 : 0, b = turned ? 1.1 : 0;
    for (int i = 0; i < count; i++, p += 3) {
        double x = cos(a) * p[0] - sin(a) * p[1], y = sin(a) * p[0] + cos(a) * p[1], z = p[2];
        p[0] = x * scale;
        p[1] = (cos(b) * y - sin(b) * z) * scale;
        p[2] = (sin(b) * y + cos(b) * z) * scale;
    }
}

/* All rows, f[count][count], and the areas. */
static void factors(const struct RadPolygons *polygons, double *f, double *areas)
{
    static const struct RadMaterial grey = {{0.5, 0.5, 0.5}, {1, 1, 1}, 0};
    static RadDevice device; /* of one test: each has a process of its own */
    if (!device)
        device = radNewDevice(NULL);
    RadScene scene = radNewScene(device);
    ck_assert_int_eq(radSetSceneMaterials(scene, &grey, 1), 0);
    ck_assert_int_eq(radSetSceneSharedPolygons(scene, polygons), 0);
    ck_assert_msg(radCommitScene(scene) == 0, "%s", radGetDeviceErrorMessage(device));
    RadExchange x = radNewExchange(scene, NULL, NULL);
    ck_assert_msg(x != NULL, "%s", radGetDeviceErrorMessage(device));
    for (uint32_t i = 0; i < polygons->count; i++) {
        ck_assert_double_ge(radGetExchangeRow(x, i, f + i * polygons->count), 0);
        areas[i] = radGetScenePolygonAreas(scene)[i];
    }
    radReleaseExchange(x);
    radReleaseScene(scene);
}

/* The factor from the first of two quads, which share corners where `shared` says so; the largest
 * of its errors at all places and scales. */
static double worst(const double corner[8][3], const uint32_t indices[8], double wanted)
{
    static const double scales[] = {1, 1e-6, 1e6};
    static const uint32_t materials[2] = {0, 0};
    double most = 0;
    for (int turned = 0; turned < 2; turned++)
        for (int s = 0; s < 3; s++) {
            double p[8][3], f[4], areas[2];
            for (int i = 0; i < 8; i++)
                for (int k = 0; k < 3; k++)
                    p[i][k] = corner[i][k];
            place(p[0], 8, turned, scales[s]);
            const struct RadPolygons polygons = {.positions = p[0],
                                                 .position_count = 8,
                                                 .indices = indices,
                                                 .size = 4,
                                                 .materials = materials,
                                                 .count = 2};
            factors(&polygons, f, areas);
            most = fmax(most, fabs(f[1] - wanted));
            ck_assert_double_eq_tol(f[1] * areas[0] / (f[2] * areas[1]), 1, 1e-12);
            ck_assert(f[0] == 0 && f[3] == 0);
        }
    return most;
}

START_TEST(test_plates)
{
    static const uint32_t indices[8] = {0, 1, 2, 3, 4, 7, 6, 5};
    for (double gap = 1e-8; gap < 2e3; gap *= 10) {
        const double p[8][3] = {{0, 0, 0},   {1, 0, 0},   {1, 1, 0},   {0, 1, 0},
                                {0, 0, gap}, {1, 0, gap}, {1, 1, gap}, {0, 1, gap}};
        double wanted = plates_factor(gap), error = worst(p, indices, wanted);
        ck_assert_msg(error <= 1e-8, "gap %g: %.12g is wrong by %.1e", gap, wanted, error);
    }
}
END_TEST

START_TEST(test_hinges)
{
    static const uint32_t indices[8] = {0, 1, 2, 3, 0, 4, 5, 1};
    static const double degrees[] = {0.01, 0.03, 0.1, 0.5, 1,   2,   5,   10,  15,  20,  30,
                                     45,   60,   75,  90,  100, 120, 135, 150, 165, 175, 179};
    for (size_t i = 0; i < sizeof degrees / sizeof *degrees; i++) {
        double phi = degrees[i] * PI / 180, c = cos(phi), s = sin(phi);
        const double p[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, c, s}, {1, c, s}};
        double wanted = hinge_factor(phi), error = worst(p, indices, wanted);
        ck_assert_msg(error <= 1e-8, "%g degrees: %.12g is wrong by %.1e", degrees[i], wanted,
                      error);
    }
}
END_TEST

START_TEST(test_strips)
{
    static const uint32_t indices[8] = {0, 4, 5, 1, 0, 1, 2, 3};
    for (double width = 1e-6; width < 2; width *= 10) {
        const double p[8][3] = {{0, 0, 0}, {1, 0, 0},     {1, 1, 0},
                                {0, 1, 0}, {0, 0, width}, {1, 0, width}};
        double wanted = strip_factor(width), error = worst(p, indices, wanted);
        ck_assert_msg(error <= 1e-8, "width %g: %.12g is wrong by %.1e", width, wanted, error);
    }
}
END_TEST

/* The strip in two parts, of which neither has the square's edge for its own: what they exchange
 * with the square adds up. */
START_TEST(test_parts_of_strips)
{
    static const uint32_t indices[12] = {0, 1, 2, 3, 0, 4, 5, 6, 6, 5, 7, 1},
                          materials[3] = {0, 0, 0};
    for (double width = 1e-6; width < 2; width *= 10)
        for (int turned = 0; turned < 2; turned++) {
            double p[8][3] = {{0, 0, 0},     {1, 0, 0},       {1, 1, 0},   {0, 1, 0},
                              {0, 0, width}, {0.3, 0, width}, {0.3, 0, 0}, {1, 0, width}};
            double f[9], areas[3];
            place(p[0], 8, turned, 1);
            const struct RadPolygons polygons = {.positions = p[0],
                                                 .position_count = 8,
                                                 .indices = indices,
                                                 .size = 4,
                                                 .materials = materials,
                                                 .count = 3};
            factors(&polygons, f, areas);
            double mean = (areas[1] * f[3] + areas[2] * f[6]) / (areas[1] + areas[2]);
            ck_assert_msg(fabs(mean - strip_factor(width)) <= 1e-8, "width %g: %.12g not %.12g",
                          width, mean, strip_factor(width));
        }
}
END_TEST

/* A wedge whose sides are cells x cells faces, or twice as many triangles. Returns the factor of
 * one side. */
static double wedge(double phi, int cells, int triangles, int turned)
{
    const uint32_t n = (uint32_t)cells, corners = (n + 1) * (n + 1),
                   of_side = n * n * (triangles ? 2 : 1), size = triangles ? 3 : 4,
                   count = 2 * of_side;
    double *p = malloc(2 * (size_t)corners * 3 * sizeof *p), *f = malloc(sizeof *f * count * count),
           *areas = malloc(sizeof *areas * count), sum = 0, area = 0;
    uint32_t *indices = malloc(sizeof *indices * size * count),
             *materials = calloc(count, sizeof *materials), *at = indices;
    for (uint32_t side = 0; side < 2; side++)
        for (uint32_t i = 0; i < corners; i++) {
            double *c = p + 3 * (side * corners + i), x = i % (n + 1) / (double)n,
                   y = i / (n + 1) / (double)n;
            c[0] = x;
            c[1] = side ? y * cos(phi) : y;
            c[2] = side ? y * sin(phi) : 0;
        }
    place(p, (int)(2 * corners), turned, 1);
    for (uint32_t side = 0; side < 2; side++)
        for (uint32_t i = 0; i < n * n; i++) {
            uint32_t a = side * corners + i / n * (n + 1) + i % n, right = side ? a + n + 1 : a + 1,
                     up = side ? a + 1 : a + n + 1, far = a + n + 2;
            const uint32_t quad[4] = {a, right, far, up}, two[6] = {a, right, far, a, far, up};
            for (uint32_t k = 0; k < (triangles ? 6 : 4); k++)
                *at++ = triangles ? two[k] : quad[k];
        }
    const struct RadPolygons polygons = {.positions = p,
                                         .position_count = 2 * corners,
                                         .indices = indices,
                                         .size = size,
                                         .materials = materials,
                                         .count = count};
    factors(&polygons, f, areas);
    for (uint32_t i = 0; i < of_side; i++) {
        area += areas[i];
        for (uint32_t j = of_side; j < count; j++)
            sum += areas[i] * f[i * count + j];
    }
    free(p);
    free(f);
    free(areas);
    free(indices);
    free(materials);
    return sum / area;
}

/* Of sides of many faces each sees all of the other side's, however sharp the wedge is: face by
 * face, and in groups, whose pairs are what the tolerance asks for. */
START_TEST(test_wedges)
{
    static const double degrees[] = {0.1, 1, 10, 40, 65, 130};
    for (size_t i = 0; i < sizeof degrees / sizeof *degrees; i++) {
        double phi = degrees[i] * PI / 180, wanted = hinge_factor(phi);
        for (int k = 0; k < 4; k++) {
            double f = wedge(phi, k < 2 ? 4 : 14, k % 2, k > 0);
            double error = fabs(f - wanted), most = k < 2 ? 1e-7 : 3e-4;
            ck_assert_msg(error <= most, "%g degrees, %d: %.12g is wrong by %.1e", degrees[i], k,
                          wanted, error);
        }
    }
}
END_TEST

int main(void)
{
    Suite *s = suite_create("exact factors");
    TCase *t = tcase_create("exact factors");
    tcase_set_timeout(t, 60);
    tcase_add_test(t, test_references);
    tcase_add_test(t, test_plates);
    tcase_add_test(t, test_hinges);
    tcase_add_test(t, test_strips);
    tcase_add_test(t, test_parts_of_strips);
    tcase_add_test(t, test_wedges);
    suite_add_tcase(s, t);
    return suite_failures(s) != 0;
}
