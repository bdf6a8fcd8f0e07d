/* check_form_factor_levels.c - form factors by 1 / d^2, by rays and by hemicube: errors where the
 * answer is known, convergence, and the order of the levels.
 * Once is enough: it is about numbers; that memory is used well, shorter suites tell.
 * SPDX-License-Identifier: MIT */
#include <stdio.h>
#include "study/closed_forms.h"
#include "runtime/make_pair.h"
#include "suite.h"
#include "terms/form_factor.h"

static const enum form_factor_level levels[] = {
    FORM_FACTOR_INVERSE_SQUARE, FORM_FACTOR_DISC,    FORM_FACTOR_HEMICUBE, FORM_FACTOR_POINT,
    FORM_FACTOR_RAYS,           FORM_FACTOR_POLYGON, FORM_FACTOR_CONTOUR};
enum { LEVELS = sizeof levels / sizeof *levels };

static double at_level(const struct two *t, enum form_factor_level level)
{
    struct discussion d = two_discussion(t);
    return form_factor_of(&d, level);
}

/* Of the parallel unit squares at d: 1 / (pi d^2), so 31.8 at a tenth of their side; of a hemicube
 * what a point sees, to its pixels; of rays F, to a fortieth. And far off all agree. */
START_TEST(test_parallel)
{
    for (double d = 0.01; d < 200; d *= 2.15443469) {
        struct two t;
        two_parallel(&t, 1, 1, d);
        const double f = closed_parallel(1, 1, d), point = 4 * closed_corner(0.5, 0.5, d);
        ck_assert_double_eq_tol(at_level(&t, FORM_FACTOR_INVERSE_SQUARE), 1 / (M_PI * d * d),
                                1e-14 / (d * d));
        /* an edge may be off by half a pixel's width, 1 / 128, all around */
        ck_assert_double_eq_tol(at_level(&t, FORM_FACTOR_HEMICUBE), point,
                                sqrt(point) * 2 / FORM_FACTOR_PIXELS + 1.3e-4);
        ck_assert_double_eq_tol(at_level(&t, FORM_FACTOR_RAYS), f, 0.03 * f);
        two_close(&t);
    }
    struct two near;
    two_parallel(&near, 1, 1, 0.1);
    ck_assert_double_eq_tol(at_level(&near, FORM_FACTOR_INVERSE_SQUARE), 31.8, 0.05);
    two_close(&near);
}
END_TEST

/* At right angles with a common edge, a wall of height h before a floor of width w. */
START_TEST(test_perpendicular)
{
    /* w, h; errors of 1 / d^2 and hemicube: those of one point */
    static const double wrong[][4] = {
        {1, 1, 0.591, -0.0495}, {1, 0.1, -0.711, -0.817}, {0.1, 1, -0.711, 0.066}};
    for (int i = 0; i < 3; i++) {
        struct two t;
        const double f = closed_perpendicular(wrong[i][0], wrong[i][1], 1);
        two_perpendicular(&t, wrong[i][0], wrong[i][1], 1);
        ck_assert_double_eq_tol(at_level(&t, FORM_FACTOR_INVERSE_SQUARE) / f - 1, wrong[i][2],
                                0.001);
        ck_assert_double_eq_tol(at_level(&t, FORM_FACTOR_HEMICUBE) / f - 1, wrong[i][3], 0.01);
        ck_assert_double_eq_tol(at_level(&t, FORM_FACTOR_RAYS), f, 0.03 * f);
        two_close(&t);
    }
}
END_TEST

/* L1 over random pairs, some crossing each other's planes, of what `count` rays and a hemicube of
 * `pixels` are off by: from F, and from one point. */
static void errors(int count, int pixels, double apart, double *by_rays, double *by_hemicube)
{
    unsigned state = 5;
    double rays = 0, all = 0, steps = 0, seen = 0;
    for (int i = 0; i < 2000; i++) {
        struct two t;
        two_random(&t, i % 3 == 0, apart, 1, &state);
        const double f = polygon_factor(t.a, t.b, 1), point = point_factor(t.a, t.b);
        rays += t.a->area * fabs(ray_factor(t.a, t.b, count) - f);
        all += t.a->area * f;
        steps += t.a->area * fabs(hemicube_factor(t.a, t.b, pixels) - point);
        seen += t.a->area * point;
        two_close(&t);
    }
    *by_rays = rays / all;
    *by_hemicube = steps / seen;
}

/* 64 times the rays divide the error by more than 8, which chance would; 16 times the pixels a side
 * by more than 16, which one row of pixels at a straight edge would. */
START_TEST(test_converge)
{
    for (double apart = 0; apart < 3; apart += 1.4) {
        double coarse[2], fine[2];
        errors(16, 32, apart, &coarse[0], &coarse[1]);
        errors(1024, 512, apart, &fine[0], &fine[1]);
        ck_assert_double_lt(fine[0], coarse[0] / 8);
        ck_assert_double_lt(fine[1], coarse[1] / 16);
        ck_assert(fine[0] > 0 && fine[1] > 0);
    }
}
END_TEST

/* Without bias, as long as noise does not take F above 1: the mean over pairs that differ by their
 * identities alone is F, within four standard errors, where they touch, cross and are far off. */
START_TEST(test_rays_unbiased)
{
    enum { NETS = 4000 };
    for (int i = 0; i < 4; i++) {
        struct two t;
        unsigned state = 3;
        if (i == 0)
            two_perpendicular(&t, 1, 1, 1);
        else if (i == 1)
            two_parallel(&t, 1, 2, 0.4);
        else if (i == 2)
            two_parallel(&t, 1, 1, 7);
        else
            for (two_random(&t, 0, 0, 1, &state); polygon_factor(t.a, t.b, 1) < 0.05;
                 two_random(&t, 0, 0, 1, &state))
                two_close(&t);
        const double f = polygon_factor(t.a, t.b, 1);
        double sum = 0, squares = 0;
        struct element r = *t.a, s = *t.b;
        for (int n = 0; n < NETS; n++) {
            r.id = hash64((uint64_t)n + 1);
            const double x = ray_factor(&r, &s, 16) - f;
            sum += x;
            squares += x * x;
        }
        const double mean = sum / NETS, error = sqrt(squares / NETS - mean * mean) / sqrt(NETS);
        ck_assert_double_gt(error, 0);
        ck_assert_double_lt(fabs(mean), 4 * error);
        two_close(&t);
    }
}
END_TEST

/* Polygons that share edges share no pixel and leave none out: the parts of an emitter add up to
 * it, and what is all around to all pixels, whose delta form factors sum to 1. */
START_TEST(test_hemicube_tiles)
{
    unsigned state = 19;
    for (int i = 0; i < 200; i++) {
        struct two t;
        two_random(&t, i % 3 == 0, 0.7 * (i % 2), 1, &state);
        const double whole = hemicube_factor(t.a, t.b, 128);
        double parts = 0;
        ck_assert_int_eq(hierarchy_split(&t.h, t.h.face_element[1]), 0);
        two_find(&t);
        for (uint32_t c = 0; c < t.b->children; c++)
            parts += hemicube_factor(t.a, &t.h.elements[t.b->child + c], 128);
        /* corners of parts are rounded: a pixel's middle may go both ways */
        ck_assert_double_eq_tol(parts, whole, 1e-12 + 2 * 7.8e-5 * (i % 2 == 0));
        two_close(&t);
    }
    struct two room;
    const uint32_t grey[6] = {0};
    two_start(&room);
    made_room(&room.scene, grey, 1, 1.3, 0.7);
    two_open(&room);
    for (int pixels = 2; pixels <= 512; pixels *= 4) {
        double row = 0;
        for (int wall = 1; wall < 6; wall++)
            row += hemicube_factor(room.a, &room.h.elements[room.h.face_element[wall]], pixels);
        ck_assert_double_eq_tol(row, 1, 0.6 / (pixels * pixels));
    }
    two_close(&room);
}
END_TEST

/* Both ways the same exchange, and the same bits in any unit; a level once had is kept. */
START_TEST(test_levels)
{
    unsigned state = 23;
    for (int i = 0; i < 200; i++) {
        double f[2][LEVELS];
        unsigned same = state;
        for (int scale = 0; scale < 2; scale++) {
            state = same;
            struct two t;
            two_random(&t, i % 3 == 0, 0.7 * (i % 3), 1, &state);
            if (scale) {
                hierarchy_free(&t.h);
                made_scale(&t.scene, 1024);
                two_open(&t);
            }
            for (int k = 0; k < LEVELS; k++)
                f[scale][k] = at_level(&t, levels[k]);
            struct discussion d = two_discussion(&t);
            for (int k = LEVELS - 1; k >= 0; k--)
                ck_assert(term_form_factor(&d, levels[k]) == f[scale][LEVELS - 1]);
            const double back = t.b->area * ray_factor(t.b, t.a, FORM_FACTOR_RAYS_EACH);
            ck_assert_double_le(fabs(t.a->area * f[scale][4] - back), 1e-15 * back);
            two_close(&t);
        }
        ck_assert(memcmp(f[0], f[1], sizeof f[0]) == 0);
    }
}
END_TEST

/* The order of the levels is that of the error summed over pairs near and far. */
START_TEST(test_order)
{
    double off[LEVELS] = {0}, all = 0;
    unsigned state = 29;
    for (int i = 0; i < 4000; i++) {
        struct two t;
        two_random(&t, i % 3 == 0, 0.35 * (i % 10), 1, &state);
        const double f = polygon_factor(t.a, t.b, 1);
        all += t.a->area * f;
        for (int k = 0; k < LEVELS - 1; k++)
            off[k] += t.a->area * fabs(at_level(&t, levels[k]) - f);
        two_close(&t);
    }
    printf("error of the exchange:");
    for (int k = 0; k < LEVELS - 1; k++)
        printf(" %.3g", off[k] / all);
    printf("\n");
    for (int k = 1; k < LEVELS; k++) {
        ck_assert_int_eq(levels[k], levels[k - 1] + 1);
        ck_assert_double_lt(off[k], off[k - 1]);
    }
    ck_assert_double_lt(off[4], 0.03 * all);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("form factor levels");
    TCase *c = tcase_create("form factor levels");
    tcase_set_timeout(c, 120);
    tcase_add_test(c, test_parallel);
    tcase_add_test(c, test_perpendicular);
    tcase_add_test(c, test_converge);
    tcase_add_test(c, test_rays_unbiased);
    tcase_add_test(c, test_hemicube_tiles);
    tcase_add_test(c, test_levels);
    tcase_add_test(c, test_order);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
