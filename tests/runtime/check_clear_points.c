/* check_clear_points.c - what a face's points see of another: against the contour integral, the
 * error against its estimate; small cubes, whose entries have it all.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include "engine/clear_points.h"
#include "engine/exchange.h"
#include "kernel/constants.h"
#include "kernel/polygon_factor.h"
#include "runtime/make_pair.h"
#include "suite.h"
#include "util/oracles.h"

/* A triangle or a quad, which is no parallelogram, some way off. */
static void add_face(struct scene *s, int corners, double size, double off, unsigned *state)
{
    double p[4][3], from[3], u[3], v[3];
    for (int k = 0; k < 3; k++) {
        from[k] = off * (random_unit(state) - 0.5);
        u[k] = size * (random_unit(state) - 0.5);
        v[k] = size * (random_unit(state) - 0.5);
    }
    const double a = 0.7 + random_unit(state), b = 0.7 + random_unit(state);
    for (int k = 0; k < 3; k++) {
        p[0][k] = from[k];
        p[1][k] = from[k] + u[k];
        p[2][k] = from[k] + (corners == 3 ? v[k] : a * u[k] + b * v[k]);
        p[3][k] = from[k] + v[k];
    }
    made_face(s, 0, corners, (const double(*)[3])p);
}

static int in_front(const struct element *e, const struct element *plane)
{
    for (int i = 0; i < e->vertices; i++)
        if (height3(e->vertex[i], plane->centre, plane->normal) < 0)
            return 0;
    return 1;
}

/* Faces up to ten times as large as each other, at any distance. Where something is estimated, it
 * is hardly ever too little, and never by more than is allowed for. */
START_TEST(test_pairs)
{
    struct clear_rule rules[2];
    unsigned state = 1 + (unsigned)_i;
    const int most = under_sanitizers() ? 150 : 4000;
    int pairs = 0, apart = 0, within = 0, more = 0;
    clear_rules_open(rules);
    for (int i = 0; pairs < most; i++) {
        struct two t;
        const double size = pow(10, 2 * random_unit(&state) - 1);
        two_start(&t);
        add_face(&t.scene, _i & 1 ? 4 : 3, 1, 0, &state);
        add_face(&t.scene, _i & 2 ? 4 : 3, size, 1.5 * (1 + size) * random_unit(&state), &state);
        two_open(&t);
        if (in_front(t.a, t.b) && in_front(t.b, t.a)) {
            double error, e = clear_points(rules, t.a, t.b, &error),
                          exact = t.a->area * polygon_factor(t.a, t.b, 1);
            pairs++;
            apart += !isinf(error);
            if (error < 1e-3 * exact && exact > 1e-7 * fmin(t.a->area, t.b->area)) {
                const double off = fabs(e - exact) - 1e-8 * exact; /* of the contour's own */
                within++;
                more += off > error;
                ck_assert_msg(off <= CLEAR_POINTS_REST * error,
                              "pair %d: %g, not %g, estimated to %g", i, e, exact, error);
            }
        }
        two_close(&t);
    }
    printf("of %d pairs %d apart, %d estimated to 1e-3, of which %d are off by more\n", pairs,
           apart, within, more);
    ck_assert_int_gt(apart, pairs / 2);
    ck_assert_int_gt(within, apart / 2);
    ck_assert_int_le(more, within / 200);
}
END_TEST

/* Of a face of ever smaller size at the same place, both near the digits that doubles have. */
START_TEST(test_order)
{
    struct clear_rule rules[2];
    double before = INFINITY;
    clear_rules_open(rules);
    for (double size = 0.8; size > 0.15; size *= 0.5) {
        struct two t;
        double error;
        two_start(&t);
        const double p[4][3] = {
            {0, 0, 0}, {size, 0, 0}, {size, _i ? size : 0.9 * size, 0}, {0, 0.8 * size, 0}};
        const double q[4][3] = {{1, 0, 1}, {1, 1, 1}, {1, 1, 0.3}, {1, 0, 0.2}};
        made_face(&t.scene, 0, _i ? 4 : 3, p);
        made_face(&t.scene, 0, 4, q);
        two_open(&t);
        const double e = clear_points(rules, t.a, t.b, &error),
                     exact = t.a->area * polygon_factor(t.a, t.b, 1);
        if (!isinf(error)) {
            const double off = fabs(e / exact - 1);
            ck_assert_double_lt(off, fmax(before / 64, 1e-11));
            before = off;
        }
        two_close(&t);
    }
    ck_assert_double_lt(before, 1e-9);
}
END_TEST

/* A cube whose walls are n x n squares, or twice as many triangles. */
static void cube(struct scene *s, int n, int triangles)
{
    made_open(s);
    made_material(s, 0.5, 0);
    for (int wall = 0; wall < 6; wall++)
        for (int i = 0; i < n * n; i++) {
            double p[4][3];
            for (int c = 0; c < 4; c++) {
                const double u = (i % n + (c == 1 || c == 2)) / (double)n,
                             v = (i / n + (c > 1)) / (double)n;
                p[c][wall / 2] = wall % 2;
                p[c][(wall / 2 + 1) % 3] = wall % 2 ? v : u;
                p[c][(wall / 2 + 2) % 3] = wall % 2 ? u : v;
            }
            made_face(s, 0, triangles ? 3 : 4, (const double(*)[3])p);
            memcpy(p[1], p[2], sizeof p[1]);
            memcpy(p[2], p[3], sizeof p[2]);
            if (triangles)
                made_face(s, 0, 3, (const double(*)[3])p);
        }
}

/* At the default tolerance: entries are right to 1e-6, and nothing needs a ray. */
START_TEST(test_cubes)
{
    static const int sizes[4][2] = {{4, 0}, {2, 1}, {4, 1}, {8, 0}};
    struct scene s;
    struct exchange x;
    const char *cause;
    cube(&s, sizes[_i][0], sizes[_i][1]);
    struct refiner *refiner = oracles_open("viewfactors", RELEASE_FLAT);
    const struct exchange_options o = {.tolerance = EXCHANGE_TOLERANCE, .threads = 1};
    exchange_set_tolerance(refiner, EXCHANGE_TOLERANCE);
    ck_assert_int_eq(exchange_open(&x, &s, refiner, &o, &cause), 0);
    if (s.face_count >= 96)
        ck_assert_uint_eq(x.report.links, 15);
    ck_assert_uint_eq(x.report.rays, 0);
    ck_assert(!rays_in_the_way(x.tree.rays));
    double *row = malloc(s.input_count * sizeof *row), worst = 0;
    for (uint32_t p = 0; p < s.face_count; p++) {
        const struct element *e = exchange_tree_face(&x.tree, p);
        ck_assert_double_eq_tol(exchange_row(&x, s.faces[e->face].input, row), 1, 3e-6);
        for (uint32_t q = 0; q < s.face_count; q++) {
            const struct element *f = exchange_tree_face(&x.tree, q);
            const double exact = dot3(e->normal, f->normal) > 0.9 ? 0 : polygon_factor(e, f, 1);
            worst = fmax(worst, fabs(row[s.faces[f->face].input] - exact));
        }
    }
    printf("%u faces: error of F %.1e at the most\n", (unsigned)s.face_count, worst);
    ck_assert_double_lt(worst, 1e-6);
    free(row);
    exchange_close(&x);
    refiner_close(refiner);
    made_close(&s);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("clear points");
    TCase *c = tcase_create("clear points");
    tcase_set_timeout(c, 60);
    tcase_add_loop_test(c, test_pairs, 0, 4);
    tcase_add_loop_test(c, test_order, 0, 2);
    tcase_add_loop_test(c, test_cubes, 0, under_sanitizers() ? 2 : 4);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
