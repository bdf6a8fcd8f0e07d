/* check_form_factor.c - form factors against closed forms, reciprocity, additivity, scaling.
 * SPDX-License-Identifier: MIT */
#include "study/closed_forms.h"
#include "hand.h"
#include "runtime/make_pair.h"
#include "suite.h"
#include "terms/form_factor.h"

START_TEST(test_parallel)
{
    static const double size[][3] = {{1, 1, 0.01},  {1, 1, 0.1}, {1, 1, 1},  {1, 1, 2},
                                     {2, 0.5, 0.3}, {1, 3, 5},   {1, 1, 20}, {0.03, 4, 0.7}};
    double f = closed_parallel(size[_i][0], size[_i][1], size[_i][2]);
    struct two t;
    two_parallel(&t, size[_i][0], size[_i][1], size[_i][2]);
    ck_assert_double_eq_tol(polygon_factor(t.a, t.b, 1), f, 1e-10);
    ck_assert_double_eq_tol(polygon_factor(t.a, t.b, 0), f, 1e-4 * f);
    ck_assert(hand_form_factor(t.a, t.b) == polygon_factor(t.a, t.b, 0));
    two_close(&t);
}
END_TEST

START_TEST(test_perpendicular)
{
    static const double size[][3] = {{1, 1, 1},   {1, 0.1, 1}, {0.1, 1, 1},
                                     {3, 0.5, 2}, {1, 1, 10},  {5, 5, 0.1}};
    double f = closed_perpendicular(size[_i][0], size[_i][1], size[_i][2]);
    struct two t;
    two_perpendicular(&t, size[_i][0], size[_i][1], size[_i][2]);
    ck_assert_double_eq_tol(polygon_factor(t.a, t.b, 1), f, 1e-10);
    ck_assert_double_eq_tol(polygon_factor(t.a, t.b, 0), f, 1e-4 * f);
    two_close(&t);
}
END_TEST

/* The two forms above against the values of an independent program (View3D's manual). */
START_TEST(test_published)
{
    ck_assert_double_eq_tol(closed_parallel(1, 1, 1), 0.1998248956983874, 1e-13);
    ck_assert_double_eq_tol(closed_perpendicular(1, 1, 1), 0.2000437760754032, 1e-13);
}
END_TEST

/* A point under the corner of a rectangle. */
START_TEST(test_point)
{
    struct polygon q = {4, {{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}}};
    const double p[3] = {0, 0, 0}, n[3] = {0, 0, 1}, centre[3] = {0.5, 0.5, 0};
    ck_assert_double_eq_tol(lambert_sum(p, n, (const double(*)[3])q.v, q.n), 0.1385316060, 1e-10);
    ck_assert_double_eq_tol(lambert_sum(centre, n, (const double(*)[3])q.v, q.n), 0.2394564705,
                            1e-10);
}
END_TEST

/* A_r F_rs = A_s F_sr, 0 <= F <= 1, and both releases agree to the bit. */
START_TEST(test_reciprocity)
{
    unsigned state = 7;
    for (int i = 0; i < 2000; i++) {
        struct two t;
        two_random(&t, 0, 0.7, 1, &state);
        double f = polygon_factor(t.a, t.b, 0);
        double g = polygon_factor(t.b, t.a, 0);
        ck_assert(f >= 0 && f <= 1 && g >= 0 && g <= 1);
        ck_assert_double_eq_tol(t.a->area * f, t.b->area * g, 1e-15);
        ck_assert(f == hand_form_factor(t.a, t.b) && g == hand_form_factor(t.b, t.a));
        two_close(&t);
    }
}
END_TEST

/* What crosses a plane: the exchange of the whole is the sum of the exchanges of its parts. */
START_TEST(test_additive)
{
    unsigned state = 11;
    for (int i = 0; i < 300; i++) {
        double parts = 0;
        struct two t;
        two_random(&t, 0, 0.7, 1, &state);
        double whole = t.a->area * polygon_factor(t.a, t.b, 1);
        ck_assert_int_eq(hierarchy_split(&t.h, t.h.face_element[0]), 0);
        two_find(&t);
        for (int c = 0; c < 4; c++) {
            const struct element *e = &t.h.elements[t.a->child + (uint32_t)c];
            parts += e->area * polygon_factor(e, t.b, 1);
        }
        ck_assert_double_eq_tol(parts, whole, 1e-9 * t.a->area);
        two_close(&t);
    }
}
END_TEST

/* Powers of two change no bit. */
START_TEST(test_scale)
{
    unsigned state = 13;
    for (int i = 0; i < 300; i++) {
        double f[3];
        unsigned same = state;
        for (int k = 0; k < 3; k++) {
            state = same;
            struct two t;
            two_random(&t, 0, 0.7, 1, &state);
            hierarchy_free(&t.h);
            made_scale(&t.scene, k == 0 ? 1 : k == 1 ? 1024 : 1 / 1024.0);
            two_open(&t);
            f[k] = polygon_factor(t.a, t.b, 0);
            two_close(&t);
        }
        ck_assert(f[1] == f[0] && f[2] == f[0]);
    }
}
END_TEST

/* The disc's known failures stay what they were measured to be. */
START_TEST(test_disc_fails)
{
    struct discussion d = {0};
    struct two t;
    two_parallel(&t, 1, 1, 0.1);
    d.receiver = t.a;
    d.emitter = t.b;
    ck_assert_double_eq_tol(form_factor_disc(&d) / closed_parallel(1, 1, 0.1) - 1, 0.17, 0.01);
    /* so near, the polygon */
    ck_assert_double_eq_tol(term_form_factor(&d, FORM_FACTOR_DISC), closed_parallel(1, 1, 0.1),
                            1e-8);
    ck_assert_int_eq(d.terms.form_factor_level, FORM_FACTOR_POLYGON);
    /* never falls back */
    ck_assert_double_eq_tol(term_form_factor(&d, FORM_FACTOR_DISC), closed_parallel(1, 1, 0.1),
                            1e-8);
    two_close(&t);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("form factor");
    TCase *c = tcase_create("form factor");
    tcase_set_timeout(c, 120);
    tcase_add_test(c, test_published);
    tcase_add_loop_test(c, test_parallel, 0, 8);
    tcase_add_loop_test(c, test_perpendicular, 0, 6);
    tcase_add_test(c, test_point);
    tcase_add_test(c, test_reciprocity);
    tcase_add_test(c, test_additive);
    tcase_add_test(c, test_scale);
    tcase_add_test(c, test_disc_fails);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
