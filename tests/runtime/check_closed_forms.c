/* check_closed_forms.c - the finest form factor against every closed form there is for two things
 * with nothing between, at random dimensions; and the coarse levels against the errors they are
 * known to make.
 * Once is enough: it is about numbers; that memory is used well, shorter suites tell.
 * SPDX-License-Identifier: MIT */
#include <stdio.h>
#include "study/closed_forms.h"
#include "runtime/make_pair.h"
#include "suite.h"
#include "terms/form_factor.h"

static double exact(const struct two *t)
{
    struct discussion d = two_discussion(t);
    return term_form_factor(&d, FORM_FACTOR_CONTOUR);
}

/* The listed values, to all their digits: what the formulas below were copied wrong from would
 * show here. */
START_TEST(test_listed)
{
    static const double plates[][2] = {
        {0.01, 0.9804166029}, {0.1, 0.8269945224}, {1, 0.1998248956983874}, {2, 0.0685895888}};
    static const double strips[][2] = {
        {10, 0.3863824893}, {100, 0.4114200245}, {1000, 0.4139341982}};
    struct two t;
    for (int i = 0; i < 4; i++) {
        two_parallel(&t, 1, 1, plates[i][0]);
        ck_assert_double_eq_tol(exact(&t), plates[i][1], 1e-10);
        two_close(&t);
    }
    for (int i = 0; i < 3; i++) {
        two_parallel(&t, 1, strips[i][0], 1);
        ck_assert_double_eq_tol(exact(&t), strips[i][1], 1e-9);
        two_close(&t);
    }
    two_perpendicular(&t, 1, 1, 1);
    ck_assert_double_eq_tol(exact(&t), 0.2000437760754032, 1e-12);
    two_close(&t);
    two_perpendicular(&t, 1, 0.1, 1);
    ck_assert_double_eq_tol(exact(&t), 0.0432513694, 1e-10);
    two_close(&t);
    ck_assert_double_eq_tol(closed_discs(1, 1, 1), (3 - sqrt(5)) / 2, 1e-14);
    ck_assert_double_eq_tol(closed_corner(1, 1, 1), 0.1385316060, 1e-10);
    ck_assert_double_eq_tol(4 * closed_corner(0.5, 0.5, 1), 0.2394564705, 1e-10);
}
END_TEST

/* Sides and distances over two decades either way, so up to 1 : 10,000; and both ways round. */
START_TEST(test_rectangles)
{
    unsigned state = 3;
    double worst[2] = {0, 0};
    for (int i = 0; i < 4000; i++) {
        double a = random_size(&state, 100), b = random_size(&state, 100),
               c = random_size(&state, 100);
        struct two t;
        two_parallel(&t, a, b, c);
        double e = fabs(exact(&t) - closed_parallel(a, b, c));
        worst[0] = e > worst[0] ? e : worst[0];
        two_close(&t);
        two_perpendicular(&t, a, b, c);
        double f = closed_perpendicular(a, b, c);
        e = fabs(exact(&t) - f);
        const struct element *swap = t.a;
        t.a = t.b;
        t.b = swap;
        e = fmax(e, fabs(exact(&t) - closed_perpendicular(b, a, c)));
        worst[1] = e > worst[1] ? e : worst[1];
        two_close(&t);
    }
    printf("4,000 dimensions each: error of F at the most %.1e parallel, %.1e perpendicular\n",
           worst[0], worst[1]);
    ck_assert_double_lt(worst[0], 1e-9);
    ck_assert_double_lt(worst[1], 1e-9);
}
END_TEST

/* Slivers 1 : 10,000, beside each other, along a common edge and across. */
START_TEST(test_slivers)
{
    unsigned state = 5;
    for (int i = 0; i < 300; i++) {
        double l = random_size(&state, 10), w = 1e-4 * l,
               d = l * pow(10, -5 + 5 * random_unit(&state));
        struct two t;
        two_parallel(&t, l, w, d);
        ck_assert_double_eq_tol(exact(&t), closed_parallel(l, w, d),
                                1e-6 * closed_parallel(l, w, d));
        two_close(&t);
        two_perpendicular(&t, w, d, l);
        ck_assert_double_eq_tol(exact(&t), closed_perpendicular(w, d, l),
                                1e-6 * closed_perpendicular(w, d, l));
        two_close(&t);
        two_perpendicular(&t, l, d, w);
        ck_assert_double_eq_tol(exact(&t), closed_perpendicular(l, d, w), 1e-8);
        two_close(&t);
    }
}
END_TEST

/* From the centre of a small square, which may stand anywhere and be turned: every rectangle at
 * a point is a sum of four corners. */
START_TEST(test_point)
{
    unsigned state = 7;
    for (int i = 0; i < 2000; i++) {
        double w = random_size(&state, 10), l = random_size(&state, 10),
               h = random_size(&state, 10);
        double x = w * random_unit(&state), y = l * random_unit(&state);
        struct two t;
        two_start(&t);
        made_quad(&t.scene, 0, x - 0.1, y - 0.1, 0, 0.2, 0, 0, 0, 0.2, 0);
        made_quad(&t.scene, 0, 0, 0, h, 0, l, 0, w, 0, 0);
        two_open(&t);
        struct discussion d;
        d = two_discussion(&t);
        double f = closed_corner(x, y, h) + closed_corner(w - x, y, h) + closed_corner(x, l - y, h)
                   + closed_corner(w - x, l - y, h);
        ck_assert_double_eq_tol(term_form_factor(&d, FORM_FACTOR_POINT), f, 1e-12);
        two_close(&t);
    }
}
END_TEST

/* Two strips of length L; what the finite length takes is c / L + O(1 / L^2), so F = 2 F(2L) -
 * F(L). */
START_TEST(test_strips)
{
    unsigned state = 9;
    int n = 0;
    for (int i = 0; i < 300; i++) {
        double p[4][2], f[2], length = 2000;
        for (int j = 0; j < 4; j++) {
            p[j][0] = random_unit(&state) - 0.5;
            p[j][1] = random_unit(&state) + (j < 2 ? -1.1 : 0.1);
        }
        if (p[0][0] > p[1][0] || p[2][0] < p[3][0]) /* fronts: up, and down */
            continue;
        for (int j = 0; j < 2; j++, length *= 2) {
            const double a[4][3] = {{p[0][0], 0, p[0][1]},
                                    {p[1][0], 0, p[1][1]},
                                    {p[1][0], length, p[1][1]},
                                    {p[0][0], length, p[0][1]}};
            const double b[4][3] = {{p[2][0], 0, p[2][1]},
                                    {p[3][0], 0, p[3][1]},
                                    {p[3][0], length, p[3][1]},
                                    {p[2][0], length, p[2][1]}};
            struct two t;
            two_start(&t);
            made_face(&t.scene, 0, 4, a);
            made_face(&t.scene, 0, 4, b);
            two_open(&t);
            f[j] = exact(&t);
            if (j == 0) {
                double h[4] = {height3(a[0], t.b->centre, t.b->normal),
                               height3(a[1], t.b->centre, t.b->normal),
                               height3(b[0], t.a->centre, t.a->normal),
                               height3(b[1], t.a->centre, t.a->normal)};
                f[0] = h[0] > 0 && h[1] > 0 && h[2] > 0 && h[3] > 0 ? f[0] : -1;
            }
            two_close(&t);
        }
        if (f[0] < 0) /* one crosses the other's plane: not the strings' case */
            continue;
        n++;
        double strings = closed_strips(p[0], p[1], p[2], p[3]);
        ck_assert_double_eq_tol(2 * f[1] - f[0], strings, 1e-6);
    }
    ck_assert_int_gt(n, 20);
}
END_TEST

/* Two coaxial regular polygons of n sides with the discs' areas, cut into triangles: all their
 * exchange. */
static double polygons(double r, double s, double h, int n)
{
    double grow = sqrt(2 * M_PI / n / sin(2 * M_PI / n)), sum = 0;
    for (int i = 0; i < n; i++) {
        double a = 2 * M_PI / n * i, b = 2 * M_PI / n * (i + 1);
        const double low[3][3] = {{0, 0, 0},
                                  {grow * r, 0, 0},
                                  {grow * r * cos(2 * M_PI / n), grow * r * sin(2 * M_PI / n), 0}};
        const double high[3][3] = {{0, 0, h},
                                   {grow * s * cos(b), grow * s * sin(b), h},
                                   {grow * s * cos(a), grow * s * sin(a), h}};
        struct two t;
        two_start(&t);
        made_face(&t.scene, 0, 3, low);
        made_face(&t.scene, 0, 3, high);
        two_open(&t);
        sum += exact(&t); /* by symmetry the same for each triangle of the lower one */
        two_close(&t);
    }
    return sum;
}

/* Equal areas leave an error of O(1 / n^4). */
START_TEST(test_discs)
{
    unsigned state = 11;
    for (int i = 0; i < 12; i++) {
        double r = i ? random_size(&state, 3) : 1, s = i ? random_size(&state, 3) : 1,
               h = i ? random_size(&state, 3) : 1;
        double coarse = polygons(r, s, h, 48), fine = polygons(r, s, h, 96);
        ck_assert_double_eq_tol(fine, closed_discs(r, s, h), 2e-5);
        ck_assert_double_eq_tol(fine + (fine - coarse) / 15, closed_discs(r, s, h), 1e-6);
    }
}
END_TEST

/* Nearer and nearer, F tends to 1 from below. */
START_TEST(test_close)
{
    double last = 0;
    for (double d = 0.1; d > 1e-8; d /= 4) {
        struct two t;
        two_parallel(&t, 1, 1, d);
        struct discussion e;
        for (int level = FORM_FACTOR_POLYGON; level <= FORM_FACTOR_CONTOUR; level++) {
            e = two_discussion(&t);
            double f = term_form_factor(&e, (enum form_factor_level)level);
            ck_assert(f <= 1);
            if (level == FORM_FACTOR_CONTOUR) {
                ck_assert_double_eq_tol(f, closed_parallel(1, 1, d), 1e-9);
                ck_assert(f > last);
                last = f;
            }
        }
        two_close(&t);
    }
    ck_assert_double_gt(last, 0.999999);
}
END_TEST

/* What a level makes of the perpendicular squares, each side cut into 2^k. */
static double cut(enum form_factor_level level, int k)
{
    double sum = 0;
    struct two t;
    two_perpendicular(&t, 1, 1, 1);
    uint32_t first;
    for (first = t.h.face_element[0] < t.h.face_element[1] ? t.h.face_element[0]
                                                           : t.h.face_element[1];
         k > 0; k--) {
        uint32_t count = t.h.count;
        for (uint32_t i = first; i < count; i++)
            ck_assert_int_eq(hierarchy_split(&t.h, i), 0);
        first = count;
    }
    for (uint32_t i = first; i < t.h.count; i++)
        for (uint32_t j = first; j < t.h.count; j++) {
            struct discussion d = two_discussion(&t);
            d.receiver = &t.h.elements[i];
            d.emitter = &t.h.elements[j];
            if (d.receiver->face == 0 && d.emitter->face == 1)
                sum += d.receiver->area
                       * (level == FORM_FACTOR_DISC ? form_factor_disc(&d)
                                                    : term_form_factor(&d, level));
        }
    two_close(&t);
    return sum / closed_perpendicular(1, 1, 1) - 1;
}

/* Perpendicular with a common edge: cutting finer does not help the disc at first, so halving
 * misleads; one point converges, slowly, and 1 / d^2 by half each time; the polygon and the contour
 * are right at once. */
START_TEST(test_shared_edge)
{
    static const double disc[] = {-0.028, -0.044, -0.036, -0.023, -0.013},
                        square[] = {0.59, 0.32, 0.165, 0.084, 0.042};
    for (int k = 0; k < 5; k++) {
        ck_assert_double_eq_tol(cut(FORM_FACTOR_DISC, k), disc[k], 0.0006);
        ck_assert_double_eq_tol(cut(FORM_FACTOR_INVERSE_SQUARE, k), square[k], 0.002);
    }
    ck_assert_double_eq_tol(cut(FORM_FACTOR_POINT, 0), -0.0495, 0.0001);
    ck_assert_double_lt(fabs(cut(FORM_FACTOR_POINT, 3)), 0.01);
    for (int k = 0; k < 3; k++) {
        ck_assert_double_lt(fabs(cut(FORM_FACTOR_POLYGON, k)), 1e-6);
        ck_assert_double_lt(fabs(cut(FORM_FACTOR_CONTOUR, k)), 1e-10);
    }
}
END_TEST

/* Close parallel squares: +17 % at .1, +35 % at .5 by disc, as much by one point; and the rows
 * of a cube of six elements. */
START_TEST(test_close_disc)
{
    static const double wrong[][3] = {{0.01, 0.0197, 0.0196},
                                      {0.1, 0.172, 0.171},
                                      {0.5, 0.349, 0.334},
                                      {1, 0.208, 0.198},
                                      {2, 0.0747, 0.0713}};
    double opposite = 0;
    struct two t;
    struct discussion d;
    for (int i = 0; i < 5; i++) {
        double f = closed_parallel(1, 1, wrong[i][0]);
        two_parallel(&t, 1, 1, wrong[i][0]);
        d = two_discussion(&t);
        ck_assert_double_eq_tol(form_factor_disc(&d) / f - 1, wrong[i][1], 0.001);
        if (i == 3)
            opposite = form_factor_disc(&d);
        ck_assert_double_eq_tol(term_form_factor(&d, FORM_FACTOR_POINT) / f - 1, wrong[i][2],
                                0.001);
        d = two_discussion(&t);
        ck_assert_double_eq_tol(term_form_factor(&d, FORM_FACTOR_POLYGON), f, 1e-6);
        two_close(&t);
    }
    two_perpendicular(&t, 1, 1, 1);
    d = two_discussion(&t);
    double beside = form_factor_disc(&d);
    two_close(&t);
    ck_assert_double_eq_tol(4 * beside + opposite, 1.01942, 1e-5);
    ck_assert_double_eq_tol(4 * closed_perpendicular(1, 1, 1) + closed_parallel(1, 1, 1), 1, 1e-14);
}
END_TEST

/* A_r F_rs = A_s F_sr to rounding, at both levels that a link may have. */
START_TEST(test_reciprocity)
{
    unsigned state = 13;
    for (int i = 0; i < 3000; i++) {
        struct two t;
        two_random(&t, i % 3 == 0, (i % 5) * 0.5, 1, &state);
        for (int level = FORM_FACTOR_POLYGON; level <= FORM_FACTOR_CONTOUR; level++) {
            struct discussion d = two_discussion(&t), e = d;
            e.receiver = t.b;
            e.emitter = t.a;
            double there = t.a->area * term_form_factor(&d, (enum form_factor_level)level);
            double back = t.b->area * term_form_factor(&e, (enum form_factor_level)level);
            ck_assert_double_le(fabs(there - back), 4e-16 * there);
        }
        two_close(&t);
    }
}
END_TEST

/* The exchange of the whole is the sum of the exchanges of its parts: of the receiver's, the
 * emitter's and both, where planes cut too. */
START_TEST(test_parts)
{
    unsigned state = 17;
    for (int i = 0; i < 300; i++) {
        double parts = 0;
        struct two t;
        two_random(&t, i % 3 == 0, 0.7 * (i % 2), 1, &state);
        double whole = t.a->area * exact(&t);
        ck_assert_int_eq(hierarchy_split(&t.h, t.h.face_element[0]), 0);
        if (i % 2)
            ck_assert_int_eq(hierarchy_split(&t.h, t.h.face_element[1]), 0);
        two_find(&t);
        for (int j = 0; j < 4; j++)
            for (int k = 0; k < (i % 2 ? 4 : 1); k++) {
                struct discussion d = two_discussion(&t);
                d.receiver = &t.h.elements[t.a->child + (uint32_t)j];
                d.emitter = i % 2 ? &t.h.elements[t.b->child + (uint32_t)k] : t.b;
                parts += d.receiver->area * term_form_factor(&d, FORM_FACTOR_CONTOUR);
            }
        ck_assert_double_eq_tol(parts, whole, 1e-9 * t.a->area);
        two_close(&t);
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("closed forms");
    TCase *c = tcase_create("closed forms");
    tcase_set_timeout(c, 120);
    tcase_add_test(c, test_listed);
    tcase_add_test(c, test_rectangles);
    tcase_add_test(c, test_slivers);
    tcase_add_test(c, test_point);
    tcase_add_test(c, test_strips);
    tcase_add_test(c, test_discs);
    tcase_add_test(c, test_close);
    tcase_add_test(c, test_shared_edge);
    tcase_add_test(c, test_close_disc);
    tcase_add_test(c, test_reciprocity);
    tcase_add_test(c, test_parts);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
