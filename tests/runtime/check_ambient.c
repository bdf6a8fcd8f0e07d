/* Light without links. Where all walls are alike nobody need measure it: H = E / (1 - rho)
 * everywhere. Where a lamp hangs over a floor that sees black walls besides, the truth is an
 * integral over the lamp: are leaves small where it is bright, and are they right, though nothing
 * but particles has told where that is? And the same bits by any number of threads.
 * SPDX-License-Identifier: MIT */
#include "runtime/make_solve.h"
#include "engine/mend_solution.h"
#include "suite.h"

static struct solve_options without_links(int threads)
{
    struct solve_options o = quick_linear(threads);
    o.no_links = 1;
    return o;
}

START_TEST(test_furnace)
{
    struct scene scene;
    struct solve s;
    furnace_cube(&scene, 0.8);
    solve_with(&s, &scene, "bf", RELEASE_FLAT, NULL, without_links(1));
    ck_assert_uint_eq(s.report.counts.pairs, 0);
    ck_assert_uint_eq(s.report.counts.links, 0);
    for (uint32_t i = 0; i < s.hierarchy.count; i++) {
        ck_assert_double_eq_tol(s.state.irradiance[i], 5, 1e-12);
        ck_assert_double_eq_tol(s.state.radiosity[i], 5, 1e-12);
    }
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* A lamp 20 cm wide, half a metre above the middle of a floor of 4 m by 5 m, which glows (W/m2):
 * the walls are black, so that none of that comes back. */
#define HIGH 0.5
#define WIDE 0.2
enum { FLOOR = 0, CELL = 6 }; /* 8 cm long */

static void lamp_over_floor(struct scene *scene, double glow)
{
    made_open(scene);
    uint32_t black = made_material(scene, 0, 0), grey = made_material(scene, 0.5, glow),
             lamp = made_material(scene, 0, 1000);
    const uint32_t walls[6] = {grey, black, black, black, black, black};
    made_room(scene, walls, 4, 5, 3);
    made_quad(scene, lamp, 2 - WIDE / 2, 2.5 - WIDE / 2, HIGH, 0, WIDE, 0, WIDE, 0, 0);
}

/* Of a point of the floor, of B = 1000 W/m2, by 100 points of the lamp. */
static double irradiance_at(const double p[3])
{
    double sum = 0;
    for (int i = 0; i < 10; i++)
        for (int j = 0; j < 10; j++) {
            double x = 2 - WIDE / 2 + (i + 0.5) * WIDE / 10 - p[0],
                   y = 2.5 - WIDE / 2 + (j + 0.5) * WIDE / 10 - p[1],
                   square = x * x + y * y + HIGH * HIGH;
            sum += HIGH * HIGH / (M_PI * square * square);
        }
    return 1000 * WIDE * WIDE * sum / 100;
}

/* Over an element that is a rectangle, by 16 points. */
static double irradiance_of(const struct element *e)
{
    double sum = 0;
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++) {
            double p[3];
            for (int k = 0; k < 3; k++)
                p[k] = e->vertex[0][k] + (i + 0.5) / 4 * (e->vertex[1][k] - e->vertex[0][k])
                       + (j + 0.5) / 4 * (e->vertex[3][k] - e->vertex[0][k]);
            sum += irradiance_at(p) / 16;
        }
    return sum;
}

/* Returns the rays that took. */
static uint64_t mend_without_links(struct solve *s, const struct scene *scene, int threads)
{
    const struct mending_goal goal = {
        .noise = 0.0065, .most = 4000000, .places = 0.065, .least = 1 << 17, .expected = 2e6};
    struct measured_error alone;
    const char *cause;
    solve_with(s, scene, "bf", RELEASE_FLAT, NULL, without_links(threads));
    ck_assert_int_eq(measure_and_mend(s, &goal, &alone, &cause), 0);
    uint64_t rays = alone.rays;
    measured_error_free(&alone);
    return rays;
}

static const double glows[] = {0, 0.01};
enum { GLOWS = sizeof glows / sizeof *glows };

START_TEST(test_lamp)
{
    struct scene scene;
    struct solve s;
    lamp_over_floor(&scene, glows[_i]);
    uint64_t rays = mend_without_links(&s, &scene, 2);
    double off = 0, all = 0;
    for (uint32_t i = 0; i < s.hierarchy.count; i++) {
        const struct element *e = &s.hierarchy.elements[i];
        if (!e->vertices || e->face != FLOOR || (e->children ? e->depth != CELL : e->depth > CELL))
            continue;
        double H = irradiance_of(e);
        off += e->area * fabs(s.mended.irradiance[i] - H);
        all += e->area * H;
    }
    printf("floor: cells off by %.2f %%, %.3g rays\n", 100 * off / all, (double)rays);
    ck_assert_double_lt(off / all, 0.05); /* half as much again in the root mean square */
    ck_assert_uint_lt(rays, 800000);      /* 1.3 million by leaves of one size */
    solve_close(&s);
    made_close(&scene);
}
END_TEST

START_TEST(test_same_bits)
{
    static const int threads[] = {1, 2, 5};
    double *first = NULL;
    uint32_t count = 0;
    for (int i = 0; i < 3; i++) {
        struct scene scene;
        struct solve s;
        lamp_over_floor(&scene, 0);
        (void)mend_without_links(&s, &scene, threads[i]);
        size_t size = s.hierarchy.count * sizeof *first;
        if (i == 0) {
            count = s.hierarchy.count;
            memcpy(first = malloc(size), s.mended.irradiance, size);
        }
        ck_assert_uint_eq(s.hierarchy.count, count);
        ck_assert_int_eq(memcmp(first, s.mended.irradiance, size), 0);
        solve_close(&s);
        made_close(&scene);
    }
    free(first);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("ambient");
    TCase *tests = tcase_create("");
    tcase_set_timeout(tests, 60);
    tcase_add_test(tests, test_furnace);
    tcase_add_loop_test(tests, test_lamp, 0, GLOWS);
    tcase_add_test(tests, test_same_bits);
    suite_add_tcase(suite, tests);
    return suite_failures(suite) > 0;
}
