/* check_entries.c - entries of view factors in half shadow against quadrature that shares nothing
 * with the library (quad_judge.h): three quads, each in the others' half shadow, many of which
 * cross each other's plane. Every entry is within the tolerance asked for, of itself or of 1e-4,
 * and none is above what it is where nothing stands between.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include "engine/exchange.h"
#include "util/oracles.h"
#include "scene/make_scene.h"
#include "runtime/quad_judge.h"
#include "suite.h"

enum { QUADS = 3, SCENES = 45 };

/* f[QUADS][QUADS] by the library. Returns the error it estimates. */
static double factors(const double (*quad)[4][3], double tolerance, double f[QUADS][QUADS])
{
    struct scene scene;
    struct exchange x;
    const char *cause;
    made_open(&scene);
    made_material(&scene, 0.5, 0);
    for (int i = 0; i < QUADS; i++)
        made_face(&scene, 0, 4, quad[i]);
    struct refiner *refiner = oracles_open("viewfactors", RELEASE_FLAT);
    exchange_set_tolerance(refiner, tolerance);
    const struct exchange_options options = {.tolerance = tolerance, .threads = 1};
    ck_assert_int_eq(exchange_open(&x, &scene, refiner, &options, &cause), 0);
    for (uint32_t i = 0; i < QUADS; i++)
        (void)exchange_row(&x, i, f[i]);
    double error = x.report.entry_error;
    exchange_close(&x);
    refiner_close(refiner);
    made_close(&scene);
    return error;
}

/* Returns the largest error, as a share of what is allowed. */
static double judge(const double (*quad)[4][3], double tolerance, int cells)
{
    double f[QUADS][QUADS], worst = 0;
    double estimate = factors(quad, tolerance, f);
    ck_assert(estimate >= 0 && estimate < 1);
    for (int i = 0; i < QUADS; i++)
        for (int j = 0; j < QUADS; j++) {
            if (i == j) {
                ck_assert(f[i][j] == 0);
                continue;
            }
            double right = judge_factor(quad[i], quad[j], quad[QUADS - i - j], cells),
                   clear = judge_factor(quad[i], quad[j], NULL, cells / 4);
            if (f[i][j] > 0.99 * clear)
                clear = judge_factor(quad[i], quad[j], NULL, 2 * cells);
            double share = fabs(f[i][j] - right) / (tolerance * fmax(right, 1e-4));
            if (share > 1)
                printf("F_%d%d is %.9g, not %.9g: %.2f of the tolerance %g\n", i, j, f[i][j], right,
                       share, tolerance);
            worst = fmax(worst, share);
            ck_assert_double_le(f[i][j], clear * (1 + 1e-5));
        }
    return worst;
}

START_TEST(test_crossing_planes)
{
    static const double quad[QUADS][4][3] = {
        {{22, 0, 0}, {22, 0, 22}, {15, 45, 22}, {15, 45, 0}},
        {{33, 67, 5}, {33, 153, 5}, {-22, 153, 5}, {-22, 67, 5}},
        {{0, 0, 0}, {0, 67, 0}, {0, 67, 22}, {0, 0, 22}}};
    double f[QUADS][QUADS];
    (void)factors(quad, 3e-4, f);
    ck_assert_double_eq_tol(f[0][1] / 0.00122079, 1, 3e-4);
    ck_assert_double_lt(judge(quad, 3e-4, 96), 1);
    ck_assert_double_lt(judge(quad, 3e-3, 24), 1);
}
END_TEST

static double chance(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) * (1 / 9007199254740992.0);
}

/* A trapezoid anywhere in a cube, any way up. */
static void random_quad(double v[4][3], uint64_t *state)
{
    double u[3], w[3], n[3], o[3] = {0, 0, 0}, uu, uw, ww;
    do {
        for (int k = 0; k < 3; k++) {
            u[k] = 2 * chance(state) - 1;
            w[k] = 2 * chance(state) - 1;
        }
        judge_cross(o, u, w, n);
        uu = judge_dot(u, u);
        uw = judge_dot(u, w);
        ww = judge_dot(w, w);
    } while (!(uu > 0.1 && ww > 0.1 && fabs(uw) < 0.5 * sqrt(uu * ww)));
    double narrow = 0.4 + 0.6 * chance(state);
    for (int k = 0; k < 3; k++) {
        double c = 2 * chance(state) - 1;
        v[0][k] = c - 0.5 * u[k] - 0.5 * w[k];
        v[1][k] = c + 0.5 * u[k] - 0.5 * w[k];
        v[2][k] = c + 0.5 * narrow * u[k] + 0.5 * w[k];
        v[3][k] = c - 0.5 * narrow * u[k] + 0.5 * w[k];
    }
}

/* Does an edge of a meet b, made larger by a tenth? */
static int meets(const double (*a)[3], const double (*b)[3])
{
    double large[4][3], n[3], m[3], p[3];
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 3; k++)
            large[i][k] = 1.1 * b[i][k] - 0.1 * 0.25 * (b[0][k] + b[1][k] + b[2][k] + b[3][k]);
    judge_cross(b[0], b[1], b[2], n);
    for (int i = 0; i < 4; i++) {
        const double *from = a[i], *to = a[(i + 1) % 4];
        double h = judge_dot(n, from) - judge_dot(n, b[0]),
               g = judge_dot(n, to) - judge_dot(n, b[0]);
        int inside = (h > 0) != (g > 0);
        for (int k = 0; k < 3 && inside; k++)
            p[k] = from[k] + h / (h - g) * (to[k] - from[k]);
        for (int e = 0; e < 4 && inside; e++) {
            judge_cross(large[e], large[(e + 1) % 4], p, m);
            inside = judge_dot(m, n) > 0;
        }
        if (inside)
            return 1;
    }
    return 0;
}

/* The two without the third, and with it, by few points: does it shade, and cross a plane? */
static int of_interest(const double (*quad)[4][3])
{
    int shaded = 0;
    for (int i = 0; i < QUADS; i++)
        for (int j = 0; j < QUADS; j++)
            if (i != j && meets(quad[i], quad[j]))
                return 0;
    for (int i = 0; i < QUADS; i++) {
        int j = (i + 1) % QUADS;
        double clear = judge_factor(quad[i], quad[j], NULL, 4),
               seen = judge_factor(quad[i], quad[j], quad[QUADS - i - j], 4);
        shaded += seen > 1e-4 && seen < 0.98 * clear;
    }
    return shaded > 0;
}

START_TEST(test_random_scenes)
{
    uint64_t state = 17;
    double worst = 0, quad[QUADS][4][3];
    for (int scene = 0; scene < SCENES;) {
        for (int i = 0; i < QUADS; i++)
            random_quad(quad[i], &state);
        if (!of_interest((const double(*)[4][3])quad))
            continue;
        worst = fmax(worst, judge((const double(*)[4][3])quad, 1e-3, 24));
        scene++;
    }
    ck_assert_double_lt(worst, 1);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("entries");
    TCase *tests = tcase_create("entries");
    tcase_set_timeout(tests, 60);
    suite_add_tcase(suite, tests);
    tcase_add_test(tests, test_crossing_planes);
    tcase_add_test(tests, test_random_scenes);
    return suite_failures(suite);
}
