/* check_plain_math.c - the logarithm and the angle of form factors against long doubles, over their
 * whole range; and the loops over them, whose bits do not depend on the vectors that the processor
 * has.
 * SPDX-License-Identifier: MIT */
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "kernel/contour_factor.h"
#include "kernel/lambert.h"
#include "kernel/plain_math.h"
#include "suite.h"

/* Evenly in [0, 1), by a xorshift of 64 bits. */
static double even(uint64_t *state)
{
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    return (double)(*state >> 11) * 0x1p-53;
}

/* How many units of its last place `got` is off what it should be. */
static double units(double got, long double wanted)
{
    double size = fabs((double)wanted), unit = nextafter(size, INFINITY) - size;
    return (double)(fabsl((long double)got - wanted) / (long double)unit);
}

START_TEST(test_log)
{
    uint64_t state = 1;
    double most = 0;
    for (int i = 0; i < (thorough() ? 5000000 : 300000); i++) {
        double x = i % 3 == 0   ? exp(1414 * even(&state) - 706)
                   : i % 3 == 1 ? exp(4 * even(&state) - 2)
                                : 1 + (even(&state) - 0.5) * exp(-36 * even(&state));
        most = fmax(most, units(plain_log(x), logl((long double)x)));
    }
    ck_assert_double_le(most, 1);
    ck_assert(plain_log(1) == 0);
    ck_assert_double_le(units(plain_log(DBL_MAX), logl((long double)DBL_MAX)), 1);
    ck_assert_double_le(units(plain_log(DBL_MIN), logl((long double)DBL_MIN)), 1);
    /* x ln x is 0 where it is to be */
    ck_assert(0 * plain_log(0) == 0);
    ck_assert(plain_log(0) < -708 && plain_log(0x1p-1074) < -708 && plain_log(0) > -710);
}
END_TEST

START_TEST(test_angle)
{
    uint64_t state = 2;
    double most = 0;
    /* the slopes where one step of the reduction ends and another begins, and the axes */
    static const double slope[] = {0.26, 0.72, 1, 1 / 0.72, 1 / 0.26, 0.5, 1e-9};
    for (int i = 0; i < (thorough() ? 5000000 : 300000); i++) {
        double s = even(&state), c = 2 * even(&state) - 1;
        if (i % 4 == 0)
            s *= exp(-690 * even(&state));
        if (i % 4 == 1)
            c *= exp(-690 * even(&state));
        if (i % 4 == 2)
            s = fabs(c) * slope[i / 4 % 7] * (1 + 1e-6 * (even(&state) - 0.5));
        most = fmax(most, units(plain_angle(s, c), atan2l((long double)s, (long double)c)));
    }
    ck_assert_double_le(most, 1.5);
    const double pi = 3.14159265358979323846;
    ck_assert(plain_angle(0, 0) == 0 && plain_angle(0, 3) == 0 && plain_angle(0, -3) == pi);
    ck_assert(plain_angle(2, 0) == pi / 2 && plain_angle(5, 5) == pi / 4);
    ck_assert(plain_angle(1e300, 1e300) == pi / 4 && plain_angle(1e-300, 1e-300) == pi / 4);
}
END_TEST

/* The widths that this processor has. */
static int widths(int width[3])
{
    int count = 0;
    width[count++] = 1;
    if (lanes_width() >= 4)
        width[count++] = 4;
    if (lanes_width() >= 8)
        width[count++] = 8;
    return count;
}

/* Now and then a coordinate from few, so that points and edges fall together and angles are 0. */
static double coordinate(uint64_t *state)
{
    return even(state) < 0.3 ? floor(3 * even(state)) - 1 : 2 * even(state) - 1;
}

START_TEST(test_widths)
{
    uint64_t state = 3;
    int width[3], kinds = widths(width), wrong = 0;
    for (int i = 0; i < (thorough() ? 100000 : 5000); i++) {
        struct polygon q = {.n = 3 + i % 3};
        double at[LAMBERT_POINTS][3], n[3];
        struct lambert_edges edges[3];
        memset(edges, 0, sizeof edges);
        for (int k = 0; k < 3; k++) {
            n[k] = coordinate(&state);
            for (int j = 0; j < q.n; j++)
                q.v[j][k] = coordinate(&state);
            for (int j = 0; j < LAMBERT_POINTS; j++)
                at[j][k] = coordinate(&state);
        }
        int points = 1 + i % LAMBERT_POINTS;
        struct lambert_edges *e = &edges[0];
        e->points = points;
        e->count = points * q.n;
        memcpy(e->n, n, sizeof n);
        for (int j = 0; j < e->count + points; j++) {
            e->x[j] = coordinate(&state);
            e->y[j] = coordinate(&state);
            e->z[j] = coordinate(&state);
        }
        edges[1] = edges[2] = edges[0];
        struct contour_factor_side side[2][POLYGON_MAX];
        struct contour_factor_lines lines[3];
        struct contour_factor_seconds seconds[3];
        struct polygon p = {.n = 4};
        memcpy(p.v, at, sizeof p.v[0] * 4);
        contour_factor_sides(side[0], &p);
        contour_factor_sides(side[1], &q);
        memset(lines, 0, sizeof lines);
        memset(seconds, 0, sizeof seconds);
        for (int j = 0; j < CONTOUR_FACTOR_LINES; j++)
            lines[0].s[j] = even(&state);
        for (int j = 0; j < CONTOUR_FACTOR_SECONDS; j++) {
            seconds[0].u[j] = coordinate(&state);
            seconds[0].h[j] = fabs(coordinate(&state));
        }
        lines[1] = lines[2] = lines[0];
        seconds[1] = seconds[2] = seconds[0];
        const struct contour_factor_side *outer = &side[0][i % 4], *inner = &side[1][i % q.n];
        int edge = outer->length > 0 && inner->length > 0;
        for (int w = 0; w < kinds; w++) {
            lambert_edges_at(width[w], &edges[w]);
            contour_factor_seconds_at(width[w], CONTOUR_FACTOR_SECONDS - LANES_MOST, &seconds[w]);
            if (edge)
                contour_factor_lines_at(width[w], outer, inner, 1 + i % 60, &lines[w]);
            wrong += memcmp(&edges[w], &edges[0], sizeof edges[0]) != 0;
            wrong += memcmp(&seconds[w], &seconds[0], sizeof seconds[0]) != 0;
            wrong += memcmp(&lines[w], &lines[0], sizeof lines[0]) != 0;
            for (int j = 0; edge && j <= i % 60; j++)
                wrong += !isfinite(lines[w].value[j]);
        }
        /* many points at once, as one by one */
        double f[LAMBERT_POINTS];
        const double(*v)[3] = (const double(*)[3])q.v;
        lambert_sums(points, (const double(*)[3])at, n, v, q.n, f);
        for (int j = 0; j < points; j++)
            wrong += f[j] != lambert_sum(at[j], n, v, q.n);
    }
    ck_assert_int_eq(wrong, 0);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("plain math");
    TCase *c = tcase_create("plain math");
    tcase_set_timeout(c, 120);
    tcase_add_test(c, test_log);
    tcase_add_test(c, test_angle);
    tcase_add_test(c, test_widths);
    suite_add_tcase(suite, c);
    return suite_failures(suite);
}
