/* check_published_factors.c - view factors that others publish with their programs: the 49 cases of
 * OpenViewFactor's verification (plates, discs, cylinders, spheres, blockers) and the examples of
 * View3D's manual.
 *
 * The geometries are made here. Round shapes are prisms and polyhedra as wide, on the mean, as what
 * they stand for; how far they may be off follows from their corners. Of nested spheres the share
 * that goes from the outer one inwards is the square of the ratio of the radii, which is what is
 * asked here; the ratio itself, which OpenViewFactor has, is that of cylinders without end.
 * [github.com/OpenViewFactor/verification-scripts; Walton, View3D user manual 3.3]
 * Once is enough: it is about numbers; that memory is used well, shorter suites tell.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <stdlib.h>

#include "runtime/make_polygons.h"
#include "suite.h"

enum { CORNERS = 96 };
static const double TURN = 2 * 3.14159265358979323846;

/* As large as the circle; the front is up or down. */
static void disc(double radius, double z, int up)
{
    const double r = radius * sqrt(TURN / CORNERS / sin(TURN / CORNERS));
    for (int i = 0; i < CORNERS; i++) {
        const double a = (up ? i : -i) * TURN / CORNERS;
        corner(r * cos(a), r * sin(a), z);
    }
    end_face(CORNERS);
}

/* As wide as the cylinder from 0 to 1, on the mean. */
static void cylinder(double radius, int sides, int outwards)
{
    const double r = radius * (TURN / 2 / sides) / sin(TURN / 2 / sides);
    for (int i = 0; i < sides; i++) {
        const double a = (outwards ? i : i + 1) * TURN / sides,
                     b = (outwards ? i + 1 : i) * TURN / sides;
        corner(r * cos(a), r * sin(a), 0);
        corner(r * cos(b), r * sin(b), 0);
        corner(r * cos(b), r * sin(b), 1);
        corner(r * cos(a), r * sin(a), 1);
        end_face(4);
    }
}

/* Rings of flat trapezoids around z = middle, triangles at the poles. */
static void sphere(double radius, double middle, int outwards)
{
    enum { RINGS = 5, AROUND = 8 };
    for (int j = 0; j < RINGS; j++)
        for (int i = 0; i < AROUND; i++) {
            const double low = (j * .5 / RINGS - .25) * TURN,
                         high = ((j + 1) * .5 / RINGS - .25) * TURN, a = i * TURN / AROUND,
                         b = (i + 1) * TURN / AROUND;
            const double p[4][3] = {{cos(low) * cos(a), cos(low) * sin(a), sin(low)},
                                    {cos(low) * cos(b), cos(low) * sin(b), sin(low)},
                                    {cos(high) * cos(b), cos(high) * sin(b), sin(high)},
                                    {cos(high) * cos(a), cos(high) * sin(a), sin(high)}};
            uint32_t size = 0;
            for (int k = 0; k < 4; k++) {
                const int c = outwards ? k : 3 - k;
                if ((j == 0 && c == 1) || (j == RINGS - 1 && c == 3))
                    continue; /* a pole, a second time */
                corner(radius * p[c][0], radius * p[c][1], middle + radius * p[c][2]);
                size++;
            }
            end_face(size);
        }
}

/* What polygons 0 to from - 1 send, on the mean over their area, to polygons `to` to `end` - 1. */
static double factor(uint32_t from, uint32_t to, uint32_t end, double tolerance)
{
    static double f[FACES * FACES], areas[FACES];
    double sent = 0, area = 0;
    factors(from, tolerance, f, areas);
    for (uint32_t i = 0; i < from; i++) {
        area += areas[i];
        for (uint32_t j = to; j < end; j++)
            sent += areas[i] * f[i * scene.faces + j];
    }
    return sent / area;
}

static void near(const char *what, int i, double got, double wanted, double relative)
{
    ck_assert_msg(fabs(got - wanted) <= relative * wanted, "%s %d: %.12g, not %.12g (%.1e)", what,
                  i, got, wanted, got / wanted - 1);
}

START_TEST(test_parallel_plates)
{
    static const double cases[][2] = {{.1, .003162056838754}, {.2, .012403977313243},
                                      {.4, .046137416744875}, {.6, .093362337840650},
                                      {1, .199824895698387},  {2, .415253283577147},
                                      {4, .632036430013860},  {10, .826994522397256}};
    for (int i = 0; i < 8; i++) {
        const double a = cases[i][0], x[3] = {a, 0, 0}, y[3] = {0, a, 0};
        clear();
        rectangle((const double[3]){0, 0, 0}, x, y);
        rectangle((const double[3]){0, 0, 1}, y, x);
        near("parallel", i, factor(1, 1, 2, 0), cases[i][1], 1e-6);
    }
}
END_TEST

/* One plate lies from the edge on, or a tenth off it; the other stands so. */
START_TEST(test_perpendicular_plates)
{
    static const double cases[][4] = {
        {.1, .1, 0, .281887806787901},  {.2, .2, 0, .271036935697358},
        {.4, .4, 0, .250319555056282},  {.6, .6, 0, .231469999626555},
        {1, 1, 0, .200043776075403},    {2, 2, 0, .149299795886762},
        {4, 4, 0, .101358700221681},    {10, 10, 0, .055023979528411},
        {.1, .1, .1, .099641323889039}, {.1, 1, .1, .264776412027033},
        {.5, .1, .1, .046900754681815}, {1, 1, .1, .154206868494109},
        {2, 2, .1, .123295563178043},   {4, 4, .1, .087423913145759},
        {10, 10, .1, .049213054565814}, {10, 1, .1, .020339424193314}};
    for (int i = 0; i < 16; i++) {
        const double *c = cases[i], x[3] = {1, 0, 0}, y[3] = {0, c[0], 0}, z[3] = {0, 0, c[1]};
        clear();
        rectangle((const double[3]){0, c[2], 0}, x, y);
        rectangle((const double[3]){0, 0, c[2]}, z, x);
        near("perpendicular", i, factor(1, 1, 2, 0), c[3], 2e-6);
    }
}
END_TEST

START_TEST(test_discs)
{
    static const double cases[][3] = {{.2, .2, .037087982163740}, {.8, .8, .307190448116156},
                                      {1, 1, .381966011250105},   {2, 2, .609611796797792},
                                      {5, 5, .819002487577582},   {8, 8, .882568597329052},
                                      {.2, 10, .990095126032656}, {10, 2, .039587804026310}};
    for (int i = 0; i < 8; i++) {
        clear();
        disc(cases[i][0], 0, 1);
        disc(cases[i][1], 1, 0);
        near("discs", i, factor(1, 1, 2, 0), cases[i][2], 5e-5);
    }
}
END_TEST

/* A cylinder of height 1 in a wider one. */
START_TEST(test_cylinders)
{
    enum { SIDES = 24 };
    static const double cases[][3] = {{.125, .25, .910868433007748}, {.25, .5, .825255820427648},
                                      {.5, .75, .816594634814723},   {.75, 1, .811249542831146},
                                      {1, 2, .464548996487789},      {2, 3, .451113669487758},
                                      {10, 32, .027077832758733}};
    for (int i = 0; i < 7; i++) {
        clear();
        cylinder(cases[i][0], SIDES, 1);
        cylinder(cases[i][1], SIDES, 0);
        near("cylinders", i, factor(SIDES, SIDES, 2 * SIDES, 1e-3), cases[i][2], 4e-3);
    }
}
END_TEST

/* What leaves the inner cylinder past the outer one meets the sphere around both. */
START_TEST(test_blockers)
{
    enum { SIDES = 24 };
    static const double cases[][3] = {
        {.125, .25, .089131566992252}, {.25, .5, .174744179572352}, {.125, 1, .466134664562490}};
    for (int i = 0; i < 3; i++) {
        clear();
        cylinder(cases[i][0], SIDES, 1);
        cylinder(cases[i][1], SIDES, 0);
        sphere(3, .5, 0);
        near("blocked", i, 1 - factor(SIDES, 2 * SIDES, scene.faces, 1e-3), 1 - cases[i][2], 4e-3);
    }
    const double x[3] = {1, 0, 0}, y[3] = {0, 1, 0}, wide[3] = {3, 0, 0}, deep[3] = {0, 3, 0};
    clear();
    rectangle((const double[3]){0, 0, 0}, x, y);
    rectangle((const double[3]){0, 0, 1}, y, x);
    rectangle((const double[3]){-1, -1, .5}, wide, deep);
    ck_assert_double_eq(factor(1, 1, 2, 0), 0);
}
END_TEST

START_TEST(test_spheres)
{
    static const double outer[] = {1.5, 2, 3};
    for (int i = 0; i < 3; i++) {
        clear();
        sphere(1, 0, 1);
        const uint32_t faces = scene.faces;
        sphere(outer[i], 0, 0);
        near("out of a sphere", i, factor(faces, faces, 2 * faces, 1e-3), 1, 1e-3);
    }
    static const double inner[] = {2, 1.5, 1};
    for (int i = 0; i < 3; i++) {
        clear();
        sphere(3, 0, 0);
        const uint32_t faces = scene.faces;
        sphere(inner[i], 0, 1);
        near("into a sphere", i, factor(faces, faces, 2 * faces, 1e-3), inner[i] * inner[i] / 9,
             3e-3);
    }
}
END_TEST

/* The cube of View3D's manual, and its two squares with a quarter of the view between them taken.
 */
START_TEST(test_view3d)
{
    const double x[3] = {1, 0, 0}, y[3] = {0, 1, 0}, z[3] = {0, 0, 1};
    clear();
    rectangle((const double[3]){0, 0, 0}, x, y);
    rectangle((const double[3]){0, 0, 0}, y, z);
    rectangle((const double[3]){0, 0, 0}, z, x);
    rectangle((const double[3]){0, 0, 1}, y, x);
    rectangle((const double[3]){1, 0, 0}, z, y);
    rectangle((const double[3]){0, 1, 0}, x, z);
    near("cube", 0, factor(1, 3, 4, 0), .199824896, 1e-6);
    for (uint32_t j = 1; j < 6; j += j == 2 ? 2 : 1)
        near("cube", (int)j, factor(1, j, j + 1, 0), .200043776, 1e-6);
    const double half[2][3] = {{.5, 0, 0}, {0, .5, 0}};
    clear();
    rectangle((const double[3]){0, 0, 0}, x, y);
    rectangle((const double[3]){0, 0, 1}, y, x);
    rectangle((const double[3]){0, 0, .5}, half[0], half[1]);
    near("squares", 0, factor(1, 1, 2, 0), .75 * .199824895698387, 3e-4);
    near("squares", 1, factor(2, 2, 3, 0), .5 * .25 * .415253283577147, 3e-4);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("published_factors");
    TCase *t = tcase_create("published_factors");
    tcase_set_timeout(t, 60);
    tcase_add_test(t, test_parallel_plates);
    tcase_add_test(t, test_perpendicular_plates);
    tcase_add_test(t, test_discs);
    tcase_add_test(t, test_cylinders);
    tcase_add_test(t, test_blockers);
    tcase_add_test(t, test_spheres);
    tcase_add_test(t, test_view3d);
    suite_add_tcase(suite, t);
    return suite_failures(suite) ? EXIT_FAILURE : EXIT_SUCCESS;
}
