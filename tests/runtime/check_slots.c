/* check_slots.c - view factors through narrow openings, and across gaps of a hair, in scenes of
 * more than a few polygons.
 *
 * The floor of a pit sees of a ceiling what its mouth leaves. From a point of the floor that is a
 * rectangle, so right is the mean, over points of the floor, of the factor from a point to a
 * rectangle across from it. [Howell's catalog, B-3]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include "radiosity.h"
#include "runtime/chance.h"
#include "runtime/make_polygons.h"
#include "study/closed_forms.h"
#include "suite.h"

static const double WIDE = 0.4, HIGH = 0.12; /* of the ceiling, and over the mouth (m) */

static double point_factor(const double low[2], const double high[2], double c)
{
    return closed_corner(high[0], high[1], c) - closed_corner(low[0], high[1], c)
           - closed_corner(high[0], low[1], c) + closed_corner(low[0], low[1], c);
}

/* Of the floor of a pit of that size, below the ceiling, whose middle is off by that. */
static double right_factor(const double size[2], double deep, const double off[2])
{
    enum { N = 400 };
    double sum = 0;
    for (int i = 0; i < N * N; i++) {
        double low[2], high[2];
        for (int k = 0; k < 2; k++) {
            const double at = size[k] * ((k ? i / N : i % N) + 0.5) / N - size[k] / 2,
                         more = (deep + HIGH) / deep;
            low[k] = fmax((-size[k] / 2 - at) * more, off[k] - WIDE / 2 - at);
            high[k] = fmin((size[k] / 2 - at) * more, off[k] + WIDE / 2 - at);
        }
        sum += point_factor(low, high, deep + HIGH);
    }
    return sum / N / N;
}

static const struct {
    double size[2], deep, off[2];
} pit[] = {{{0.005, 0.2}, 0.07, {0, 0}},
           {{0.005, 0.2}, 0.07, {0.06, 0.01}},
           {{0.003, 0.1}, 0.07, {0.05, 0}},
           {{0.01, 0.02}, 0.07, {0.07, 0.07}},
           {{0.02, 0.2}, 0.1, {-0.06, 0.02}}};

START_TEST(test_pit)
{
    enum { OTHERS = 30 };
    static double f[FACES], area[FACES];
    const double *size = pit[_i].size, *off = pit[_i].off, deep = pit[_i].deep, x = size[0] / 2,
                 y = size[1] / 2, w = WIDE / 2, right = right_factor(size, deep, pit[_i].off);
    const double floor[3] = {-x, -y, -deep}, along[3] = {2 * x, 0, 0}, across[3] = {0, 2 * y, 0},
                 up[3] = {0, 0, deep}, far[2][3] = {{x, -y, -deep}, {-x, y, -deep}},
                 ceiling[3] = {off[0] - w, off[1] - w, HIGH}, wide[3] = {2 * w, 0, 0},
                 long_[3] = {0, 2 * w, 0};
    clear();
    rectangle(floor, along, across);
    rectangle(ceiling, long_, wide);
    rectangle(floor, across, up);
    rectangle(far[0], up, across);
    rectangle(floor, up, along);
    rectangle(far[1], along, up);
    for (int i = 0; i < OTHERS; i++) { /* behind it all, facing away */
        const double at[3] = {-w + 0.01 * i, -w, -1}, u[3] = {0.005, 0, 0}, v[3] = {0, 0.01, 0};
        rectangle(at, v, u);
    }
    factors(1, 0, f, area);
    ck_assert_double_eq_tol(f[1], right, 3e-4);
}
END_TEST

/* A plate over a floor of tiles, of which it covers parts: as where a box does not quite stand on
 * it. What a tile gets is where they face each other, far from where both have their middles. */
START_TEST(test_hair)
{
    enum { TILES = 10 };
    static double f[FACES], area[FACES];
    uint64_t state = (uint64_t)_i << 32;
    double at[3] = {0}, size[2], side[2], u[3] = {0}, v[3] = {0};
    for (int k = 0; k < 2; k++) {
        side[k] = 0.3 + chance(&state);
        size[k] = 0.3 + chance(&state);
        at[k] = chance(&state) * (TILES * side[k] - size[k]);
    }
    at[2] = pow(10, -2 - _i % 3);
    u[0] = size[0];
    v[1] = size[1];
    clear();
    rectangle(at, v, u);
    u[0] = side[0];
    v[1] = side[1];
    for (int i = 0; i < TILES * TILES; i++) {
        const double low[3] = {i % TILES * side[0], i / TILES * side[1], 0};
        rectangle(low, u, v);
    }
    factors(1, 0, f, area);
    for (int i = 0; i < TILES * TILES; i++) {
        const double x = i % TILES * side[0], y = i / TILES * side[1],
                     low[2][2] = {{at[0], at[1]}, {x, y}},
                     high[2][2] = {{at[0] + size[0], at[1] + size[1]}, {x + side[0], y + side[1]}},
                     right = closed_offset(low, high, at[2]) / (size[0] * size[1]);
        ck_assert_double_eq_tol(f[1 + i], right, 3e-5);
    }
}
END_TEST

/* A flat closed box: its floor and its lid see each other, whatever the gap. */
START_TEST(test_flat_box)
{
    static const double GAP[] = {1e-4, 2e-5, 1e-5, 5e-6, 2e-6};
    static double f[FACES], area[FACES];
    const double gap = GAP[_i], o[3] = {0}, x[3] = {1, 0, 0}, y[3] = {0, 1, 0}, up[3] = {0, 0, gap},
                 low[2][2] = {{0, 0}, {0, 0}}, high[2][2] = {{1, 1}, {1, 1}};
    clear();
    rectangle(o, x, y);
    rectangle(up, y, x);
    rectangle(o, y, up);
    rectangle(x, up, y);
    rectangle(o, up, x);
    rectangle(y, x, up);
    factors(1, 0, f, area);
    ck_assert_double_eq_tol(f[1], closed_offset(low, high, gap), 1e-8);
    ck_assert_double_eq_tol(row_sum(f, 0), 1, 1e-8);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("slots");
    TCase *t = tcase_create("slots");
    tcase_set_timeout(t, 60);
    tcase_add_loop_test(t, test_pit, 0, sizeof pit / sizeof *pit);
    tcase_add_loop_test(t, test_hair, 0, under_sanitizers() ? 12 : 60);
    tcase_add_loop_test(t, test_flat_box, 0, 5);
    suite_add_tcase(suite, t);
    return suite_failures(suite) != 0;
}
