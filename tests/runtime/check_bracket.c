/* check_bracket.c - lower and upper solution: the true radiosity is between them at every point,
 * by closed forms and by furnaces of any shape, and they approach each other.
 * SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <stdlib.h>
#include "runtime/make_known.h"
#include "runtime/make_solve.h"
#include "suite.h"

static int is_leaf(const struct solve *s, uint32_t i)
{
    const struct element *e = &s->hierarchy.elements[i];
    return e->vertices && !e->children && s->operator.uncovered[i]> 0;
}

/* A point of a leaf: its centre (n = 0), or a little within corner n - 1. */
static void leaf_point(const struct element *e, int n, double p[3])
{
    for (int k = 0; k < 3; k++)
        p[k] = n == 0 ? e->centre[k]
                      : e->vertex[n - 1][k] + 1e-3 * (e->centre[k] - e->vertex[n - 1][k]);
}

static void must_enclose(const struct solve *s, uint32_t i, uint32_t band, double known)
{
    size_t at = (size_t)i * s->problem.bands + band;
    double rounding = 1e-12 * known; /* of sums over links; both may be the known value itself */
    ck_assert_msg(s->bracket.lower[at] <= known + rounding
                      && known <= s->bracket.upper[at] + rounding,
                  "element %u band %u: %.9g is not between %.9g and %.9g", (unsigned)i,
                  (unsigned)band, known, s->bracket.lower[at], s->bracket.upper[at]);
}

/* Mean over a face of the lower (0) or upper (1) solution. */
static double face_mean(const struct solve *s, uint32_t face, int upper)
{
    const double *x = upper ? s->bracket.upper : s->bracket.lower;
    double sum = 0, area = 0;
    for (uint32_t i = 0; i < s->hierarchy.count; i++) {
        const struct element *e = &s->hierarchy.elements[i];
        if (!is_leaf(s, i) || e->face != face)
            continue;
        sum += e->area * x[(size_t)i * s->problem.bands];
        area += e->area;
    }
    return sum / area;
}

static double apart(const struct solve *s)
{
    return (s->bracket.power[1] - s->bracket.power[0]) / s->bracket.power[1];
}

/* F from the point (0, 0, 0) facing up to the rectangle [x0, x1] x [y0, y1] at height d: of its
 * corners, each with the point's foot for the opposite one. */
static double corner_factor(double x, double y, double d)
{
    double a = x / d, b = y / d, p = sqrt(1 + a * a), q = sqrt(1 + b * b);
    return (a / p * atan(b / p) + b / q * atan(a / q)) / (2 * M_PI);
}

static double rectangle_factor(double x0, double x1, double y0, double y1, double d)
{
    if (!(x1 > x0 && y1 > y0))
        return 0;
    return corner_factor(x1, y1, d) - corner_factor(x0, y1, d) - corner_factor(x1, y0, d)
           + corner_factor(x0, y0, d);
}

/* ---- closed forms */

/* Unit cube with a lit ceiling; parallel unit squares; unit squares with a common edge. */
START_TEST(test_means)
{
    static const double known[3][6] = {
        {0.1712161, 1.1043616, 0.1811056, 0.1811056, 0.1811056, 0.1811056},
        {1.111165244298, 1.111165244298},
        {1.1159537, 1.1159537}};
    static char *const steps[3][3] = {{(char *)"relative=1e-2", (char *)"min_share=1e-4", NULL},
                                      {(char *)"relative=1e-3", (char *)"min_share=1e-4", NULL},
                                      {(char *)"relative=1e-4", (char *)"min_share=1e-4", NULL}};
    double before = INFINITY;
    for (int step = 0; step < 2 + thorough(); step++) {
        struct scene scene;
        made_open(&scene);
        uint32_t wall = made_material(&scene, 0.5, _i ? 1 : 0),
                 lamp = made_material(&scene, 0.5, 1);
        const uint32_t m[6] = {wall, lamp, wall, wall, wall, wall};
        if (_i == 0)
            made_room(&scene, m, 1, 1, 1);
        else
            made_quad(&scene, wall, 0, 0, 0, 1, 0, 0, 0, 1, 0);
        if (_i == 1)
            made_quad(&scene, wall, 0, 0, 1, 0, 1, 0, 1, 0, 0);
        else if (_i == 2)
            made_quad(&scene, wall, 0, 0, 0, 0, 0, 1, 1, 0, 0);
        struct solve s;
        solve_with(&s, &scene, "bracket", RELEASE_FLAT, steps[step], quick(2));
        for (uint32_t f = 0; f < scene.face_count; f++) {
            ck_assert_double_le(face_mean(&s, f, 0), known[_i][f]);
            ck_assert_double_ge(face_mean(&s, f, 1), known[_i][f]);
        }
        for (uint32_t i = 0; i < s.hierarchy.count && _i > 0; i++) {
            const struct element *e = &s.hierarchy.elements[i];
            if (!is_leaf(&s, i))
                continue;
            for (int n = 0; n < 4; n++) { /* corners that hold a point whose B is known */
                double x = e->vertex[n][0], y = e->vertex[n][1];
                int centre = x == 0.5 && y == 0.5,
                    corner = (x == 0 || x == 1) && (y == 0 || y == 1),
                    middle = (x == 0.5 && (y == 0 || y == 1)) || (y == 0.5 && (x == 0 || x == 1));
                if (_i == 1 && (centre || corner || middle))
                    must_enclose(&s, i, 0,
                                 centre   ? 1.133303564992
                                 : corner ? 1.076981393145
                                          : 1.100306232464);
            }
        }
        printf("%s: proved within %.1f %% by %zu links\n",
               _i == 0   ? "cube"
               : _i == 1 ? "parallel"
                         : "perpendicular",
               100 * apart(&s), s.refinement.link_count);
        ck_assert_double_lt(apart(&s), before);
        before = apart(&s);
        solve_close(&s);
        made_close(&scene);
    }
    ck_assert_double_lt(before, _i ? 0.1 : 0.45);
}
END_TEST

/* A square lamp over a square screen over a floor: B at every point in closed form, half shadow
 * and all. Rays prove nothing, so both hold. */
START_TEST(test_half_shadow)
{
    char *const settings[] = {(char *)"relative=3e-4", (char *)"min_share=1e-4", NULL};
    const double side = 0.75 / 2;
    struct scene scene;
    made_open(&scene);
    uint32_t lamp = made_material(&scene, 0, 1), black = made_material(&scene, 0, 0),
             floor = made_material(&scene, 0.5, 0);
    made_quad(&scene, lamp, -0.5, -0.5, 2, 0, 1, 0, 1, 0, 0);
    made_quad(&scene, black, -side, -side, 1, 2 * side, 0, 0, 0, 2 * side, 0);
    made_quad(&scene, floor, -2, -2, 0, 4, 0, 0, 0, 4, 0);
    struct solve s;
    solve_with(&s, &scene, "bracket", RELEASE_FLAT, settings, quick(2));
    int lit = 0, dark = 0;
    for (uint32_t i = 0; i < s.hierarchy.count; i++) {
        if (!is_leaf(&s, i) || s.hierarchy.elements[i].face != 2)
            continue;
        for (int n = 0; n < 5; n++) {
            double p[3];
            leaf_point(&s.hierarchy.elements[i], n, p);
            double x = p[0], y = p[1];
            double all = rectangle_factor(-0.5 - x, 0.5 - x, -0.5 - y, 0.5 - y, 2);
            double hidden =
                rectangle_factor(fmax(-0.5, -2 * side - x) - x, fmin(0.5, 2 * side - x) - x,
                                 fmax(-0.5, -2 * side - y) - y, fmin(0.5, 2 * side - y) - y, 2);
            must_enclose(&s, i, 0, 0.5 * (all - hidden));
        }
        lit += s.bracket.lower[i] > 0;
        dark += s.bracket.upper[i] <= 0;
    }
    /* and they say something: of places in the light, and of places in the umbra */
    ck_assert_int_gt(lit, 20);
    ck_assert_int_gt(dark, 0);
    printf("half shadow: %d leaves proved lit, %d dark, of %zu links\n", lit, dark,
           s.refinement.link_count);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* Every shape with B the same everywhere, materials and bands by chance. */
START_TEST(test_furnaces)
{
    static const enum known kinds[] = {KNOWN_BOX, KNOWN_PRISM, KNOWN_OCTAHEDRON, KNOWN_FURNISHED,
                                       KNOWN_SCREEN};
    struct chance c = {(uint64_t)_i + 11};
    char *const settings[] = {(char *)"relative=1e-2", (char *)"min_share=2e-2", NULL};
    struct scene scene;
    double *truth = known_open(&scene, kinds[_i % 5], &c);
    struct solve s;
    solve_with(&s, &scene, "bracket", RELEASE_FLAT, settings, quick(2));
    for (uint32_t i = 0; i < s.hierarchy.count; i++)
        for (uint32_t k = 0; k < scene.bands && is_leaf(&s, i); k++)
            must_enclose(&s, i, k, truth[k]);
    printf("furnace %d: proved within %.1f %%\n", _i, 100 * apart(&s));
    free(truth);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* ---- what holds of any scene */

/* What another oracle finds with much finer links is between, face by face, and threads change
 * nothing. */
START_TEST(test_furnished)
{
    char *const coarse[] = {(char *)"relative=3e-3", (char *)"min_share=1e-4", NULL},
                *const fine[] = {(char *)"relative=0.05", (char *)"min_share=1e-4", NULL};
    struct scene scene;
    furnished(&scene, 1);
    struct solve s, t, other;
    solve_with(&s, &scene, "bracket", RELEASE_FLAT, coarse, quick(2));
    solve_with(&t, &scene, "bracket", RELEASE_FLAT, coarse, quick(1));
    same_links(&s, &t);
    ck_assert_double_eq(s.bracket.power[0], t.bracket.power[0]);
    ck_assert_double_eq(s.bracket.power[1], t.bracket.power[1]);
    solve_with(&other, &scene, "bf_guarded", RELEASE_FLAT, fine, quick(2));
    for (uint32_t f = 0; f < scene.face_count; f++) {
        ck_assert_double_le(face_mean(&s, f, 0), face_radiosity(&other, f));
        ck_assert_double_ge(face_mean(&s, f, 1), face_radiosity(&other, f));
        /* what links say of itself is between, too */
        ck_assert_double_le(face_mean(&s, f, 0), face_radiosity(&s, f) * (1 + 1e-3));
        ck_assert_double_ge(face_mean(&s, f, 1), face_radiosity(&s, f) * (1 - 1e-3));
    }
    ck_assert_double_le(apart(&s), 0.9);
    printf("furnished: proved within %.0f %%, %zu links\n", 100 * apart(&s),
           s.refinement.link_count);
    solve_close(&s);
    solve_close(&t);
    solve_close(&other);
    made_close(&scene);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bracket");
    TCase *c = tcase_create("bracket");
    tcase_set_timeout(c, 600);
    tcase_add_loop_test(c, test_means, 0, 3);
    tcase_add_test(c, test_half_shadow);
    tcase_add_loop_test(c, test_furnaces, 0, thorough() ? 40 : 5);
    tcase_add_test(c, test_furnished);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
