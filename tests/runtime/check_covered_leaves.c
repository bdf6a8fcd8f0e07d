/* Leaves along the edges of what stands on them. A box stands on the floor of a room: are leaves
 * small where its edge crosses them, and only there? Do neighbours differ by one level at the most?
 * Do links say what they said, and does a sum over the mesh no longer count what is under the box?
 * SPDX-License-Identifier: MIT */
#include "runtime/make_solve.h"
#include "engine/covered_leaves.h"
#include "engine/element_light.h"
#include "engine/mend_solution.h"
#include "kernel/constants.h"
#include "kernel/leaf_at.h"
#include "suite.h"

/* made_room's floor; the box on it covers 1 m by 1.5 m of 4 m by 5 m, from (1.3, 1). */
enum { FLOOR = 0 };

static char *coarse[] = {"relative=0.3", NULL};

static int is_leaf_of(const struct solve *s, uint32_t i, uint32_t face)
{
    const struct element *e = &s->hierarchy.elements[i];
    return e->vertices && !e->children && e->face == face;
}

/* What the mesh of the floor shows under the box, as if it lay bare (W). */
static double shown_under(const struct solve *s)
{
    double sum = 0;
    for (uint32_t i = 0; i < s->hierarchy.count; i++) {
        const double bare = s->operator.uncovered[i];
        if (is_leaf_of(s, i, FLOOR) && bare > 0)
            sum += s->hierarchy.elements[i].area * (1 - bare) * s->state.radiosity[i];
    }
    return sum;
}

START_TEST(test_edge)
{
    struct scene scene;
    struct solve s;
    furnished_linear(&s, &scene, coarse, 0, 1);
    const double most = COVERED_SHARE * s.hierarchy.elements[0].area, power = s.report.absorbed,
                 before = shown_under(&s);
    const uint32_t count = s.hierarchy.count;
    ck_assert_uint_eq(s.hierarchy.faces[FLOOR].input, FLOOR);
    ck_assert_double_lt(s.operator.uncovered[s.hierarchy.face_element[FLOOR]], 1);
    ck_assert_int_eq(covered_leaves(&s), 0);
    double smallest = INFINITY;
    for (uint32_t i = 0; i < s.hierarchy.count; i++) {
        const struct element *e = &s.hierarchy.elements[i];
        const double bare = s.operator.uncovered[i];
        if (e->vertices && !e->children && bare > 0 && bare < 1)
            ck_assert_double_le(e->area, most);
        if (e->vertices && !e->children)
            smallest = fmin(smallest, e->area);
    }
    ck_assert_double_gt(smallest, most / 4 * (1 - 1e-9));
    printf("%u elements become %u; shown under the box %.3g W, then %.3g\n", (unsigned)count,
           (unsigned)s.hierarchy.count, before, shown_under(&s));
    /* along 5 m of edge half a leaf's side, not half of 30 cm */
    ck_assert_double_lt(shown_under(&s), 0.15 * before);
    ck_assert_uint_lt(s.hierarchy.count, count + 8000);
    solve_sum_power(&s);
    ck_assert_double_eq_tol(s.report.absorbed, power, 1e-12 * power);
    const uint32_t again = s.hierarchy.count;
    ck_assert_int_eq(covered_leaves(&s), 0);
    ck_assert_uint_eq(s.hierarchy.count, again);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* B of the leaf at a point of the floor. */
static double light_at(const struct solve *s, const double p[3])
{
    const struct element_light light = element_light_shown(s);
    double weight[4];
    const uint32_t leaf =
        leaf_at(s->hierarchy.elements, s->hierarchy.face_element[FLOOR], p, weight);
    return element_light_at(&light, leaf, 0, p);
}

/* Links say what they said, point by point. */
START_TEST(test_same_light)
{
    enum { SIDE = 40 };
    struct scene scene;
    struct solve s;
    static double before[SIDE * SIDE];
    furnished_linear(&s, &scene, coarse, 0, 1);
    const uint32_t floor = s.hierarchy.face_element[FLOOR];
    for (int pass = 0; pass < 2; pass++) {
        if (pass == 1)
            ck_assert_int_eq(covered_leaves(&s), 0);
        for (int i = 0; i < SIDE * SIDE; i++) {
            const struct element *e = &s.hierarchy.elements[floor];
            double p[3];
            for (int k = 0; k < 3; k++)
                p[k] = e->vertex[0][k]
                       + (i % SIDE + 0.37) / SIDE * (e->vertex[1][k] - e->vertex[0][k])
                       + (i / SIDE + 0.41) / SIDE * (e->vertex[3][k] - e->vertex[0][k]);
            const double light = light_at(&s, p);
            if (pass == 0)
                before[i] = light;
            else
                ck_assert_double_eq_tol(light, before[i], 1e-9 * fmax(before[i], 1e-3));
        }
    }
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* Leaves that touch along an edge: of the larger one's edge the smaller one's middle is a point. */
START_TEST(test_neighbours)
{
    struct scene scene;
    struct solve s;
    furnished_linear(&s, &scene, coarse, 0, 1);
    const uint32_t before = s.hierarchy.count;
    ck_assert_int_eq(covered_leaves(&s), 0);
    for (uint32_t i = before; i < s.hierarchy.count; i++) {
        const struct element *e = &s.hierarchy.elements[i];
        if (e->children)
            continue;
        for (int j = 0; j < e->vertices; j++) {
            double out[3], weight[4];
            for (int k = 0; k < 3; k++) {
                double middle = 0.5 * (e->vertex[j][k] + e->vertex[(j + 1) % e->vertices][k]);
                out[k] = middle + 1e-6 * (middle - e->centre[k]);
            }
            uint32_t other =
                leaf_at(s.hierarchy.elements, s.hierarchy.face_element[e->face], out, weight);
            ck_assert_int_ge(s.hierarchy.elements[other].depth + 1, e->depth);
        }
    }
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* Mended, too, for any number of threads; without slopes nothing is made. */
START_TEST(test_mended)
{
    static const struct mending_goal goal = {.noise = 0.01, .most = 200000, .places = 0.065};
    double *first = NULL;
    uint32_t count = 0;
    for (int threads = 1; threads <= 3; threads++) {
        struct scene scene;
        struct solve s;
        struct measured_error alone;
        const char *cause;
        furnished_linear(&s, &scene, coarse, 0, threads);
        ck_assert_int_eq(measure_and_mend(&s, &goal, &alone, &cause), 0);
        measured_error_free(&alone);
        const size_t size = s.hierarchy.count * sizeof *first;
        if (threads == 1) {
            count = s.hierarchy.count;
            memcpy(first = malloc(size), s.mended.radiosity, size);
            for (uint32_t i = 0; i < count; i++)
                if (is_leaf_of(&s, i, FLOOR)
                    && s.operator.uncovered[i]> 0 && s.operator.uncovered[i]<1)
                    ck_assert_double_le(s.hierarchy.elements[i].area,
                                        COVERED_SHARE * s.hierarchy.elements[0].area);
        }
        ck_assert_uint_eq(s.hierarchy.count, count);
        ck_assert_int_eq(memcmp(first, s.mended.radiosity, size), 0);
        solve_close(&s);
        made_close(&scene);
    }
    free(first);
    struct scene scene;
    struct solve s;
    furnished(&scene, 1);
    solve_with(&s, &scene, "bf", RELEASE_FLAT, NULL, quick(1));
    count = s.hierarchy.count;
    ck_assert_int_eq(covered_leaves(&s), 0);
    ck_assert_uint_eq(s.hierarchy.count, count);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("covered leaves");
    TCase *tests = tcase_create("");
    tcase_set_timeout(tests, 60);
    tcase_add_test(tests, test_edge);
    tcase_add_test(tests, test_same_light);
    tcase_add_test(tests, test_neighbours);
    tcase_add_test(tests, test_mended);
    suite_add_tcase(suite, tests);
    return suite_failures(suite) > 0;
}
