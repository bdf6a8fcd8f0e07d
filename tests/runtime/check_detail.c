/* check_detail.c - leaves that are quartered for particles (engine/detail.h): how many there are,
 * and that links say on them what they said before; those that say nothing in the end are gone
 * again.
 * SPDX-License-Identifier: MIT */
#include "runtime/make_solve.h"
#include "engine/detail.h"
#include "engine/element_light.h"
#include "engine/mend_solution.h"
#include "engine/ray_split.h"
#include "kernel/constants.h"
#include "kernel/leaf_at.h"
#include "suite.h"

static char *coarse[] = {"min_share=0.004", NULL};

/* B of the leaf at a point of a face. */
static double light_at(const struct solve *s, uint32_t face, const double p[3])
{
    const struct element_light light = element_light_shown(s);
    double weight[4];
    uint32_t leaf = leaf_at(s->hierarchy.elements, s->hierarchy.face_element[face], p, weight);
    return element_light_at(&light, leaf, 0, p);
}

/* A point of each face, and B there. */
static void look_at_faces(const struct solve *s, double (*p)[3], double *light)
{
    for (uint32_t f = 0; f < s->hierarchy.face_count; f++) {
        const struct element *e = hierarchy_surface(&s->hierarchy, f);
        for (int k = 0; k < 3; k++)
            p[f][k] = 0.37 * e->vertex[0][k] + 0.41 * e->vertex[1][k] + 0.22 * e->vertex[2][k];
        light[f] = light_at(s, f, p[f]);
    }
}

/* Does no solid stand on a part of the face of an element? */
static int is_bare(const struct solve *s, uint32_t i)
{
    return s->operator.uncovered[s->hierarchy.face_element[s->hierarchy.elements[i].face]] >= 1;
}

/* Leaves are quartered until few particles land on each, and links say what they said: at points
 * of every face, and in all that it receives. */
START_TEST(test_detail)
{
    enum { LANDINGS = 1000000 };
    struct scene scene;
    struct solve s;
    furnished_linear(&s, &scene, coarse, furnished_glows[_i], 1);
    uint32_t faces = s.hierarchy.face_count, before = s.hierarchy.count;
    double(*p)[3] = malloc(faces * sizeof *p), *light = malloc(faces * sizeof *light);
    double power = s.report.absorbed, whole = 0, tilted = 0;
    look_at_faces(&s, p, light);
    for (uint32_t f = 0; f < faces; f++) {
        const uint32_t e = s.hierarchy.face_element[f];
        whole += s.state.irradiance[e] * s.hierarchy.elements[e].area;
    }
    ck_assert_int_eq(detail_leaves(&s, LANDINGS), 0);
    ck_assert_uint_gt(s.hierarchy.count, before);
    for (uint32_t i = 0; i < s.hierarchy.count; i++) {
        const struct element *e = &s.hierarchy.elements[i];
        double here = s.state.irradiance[i] * e->area, parts = 0;
        if (!e->vertices)
            continue;
        for (int c = 0; c < e->children; c++)
            parts += s.state.irradiance[e->child + (uint32_t)c]
                     * s.hierarchy.elements[e->child + (uint32_t)c].area;
        if (e->children)
            ck_assert_double_eq_tol(parts, here, 1e-9 * whole);
        else if (is_bare(&s, i) && !e->black)
            ck_assert_double_le(here / whole * LANDINGS, MEND_DETAIL * 1.5); /* slopes tilt parts */
        if (i >= before)
            tilted = fmax(tilted, fabs(s.state.radiosity[i] - s.state.radiosity[e->parent]));
    }
    ck_assert_double_gt(tilted, 0);
    for (uint32_t f = 0; f < faces; f++)
        ck_assert_double_eq_tol(light_at(&s, f, p[f]), light[f], 1e-9 * fmax(light[f], 1e-3));
    solve_sum_power(&s);
    ck_assert_double_eq_tol(s.report.absorbed, power, 1e-12 * power);
    uint32_t count = s.hierarchy.count;
    ck_assert_int_eq(detail_leaves(&s, LANDINGS), 0);
    ck_assert_uint_le(s.hierarchy.count, count + count / 10); /* those that slopes made brighter */
    free(p);
    free(light);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* However many particles are to come, leaves are no more than about MEND_LEAVES: each is split
 * until it is worth less than one of so many, which may leave a quarter of that. */
START_TEST(test_most_leaves)
{
    struct scene scene;
    struct solve s;
    furnished_linear(&s, &scene, coarse, furnished_glows[0], 1);
    const uint32_t before = s.hierarchy.count;
    ck_assert_int_eq(detail_leaves(&s, 1e12), 0);
    uint32_t leaves = 0;
    for (uint32_t i = before; i < s.hierarchy.count; i++)
        leaves += !s.hierarchy.elements[i].children;
    ck_assert_double_gt(leaves, MEND_LEAVES);
    ck_assert_double_lt(leaves, 4 * MEND_LEAVES);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* The most elements while it is mended by so many particles. */
static uint64_t held_by(double linked, int look)
{
    const struct mending_goal goal = {
        .noise = 1e-9, .most = 400000, .linked = linked, .look = look};
    struct scene scene;
    struct solve s;
    struct measured_error alone;
    const char *cause;
    furnished_linear(&s, &scene, coarse, furnished_glows[0], 1);
    ck_assert_int_eq(measure_and_mend(&s, &goal, &alone, &cause), 0);
    const uint64_t held = s.report.held;
    measured_error_free(&alone);
    solve_close(&s);
    made_close(&scene);
    return held;
}

/* Where links are known to be nearer than what particles tell of a quarter there are none, nor in a
 * look; where they are as far off, all. */
START_TEST(test_worth)
{
    const uint64_t all = held_by(0, 0), none = held_by(0, 1);
    ck_assert_uint_gt(all, 3 * none);
    ck_assert_uint_eq(held_by(1, 0), all);
    ck_assert_uint_eq(held_by(1e-5, 0), none);
}
END_TEST

/* A copy of `count` numbers. */
static double *copied(const double *values, size_t count)
{
    double *copy = malloc(count * sizeof *copy);
    ck_assert_ptr_nonnull(copy);
    memcpy(copy, values, count * sizeof *copy);
    return copy;
}

/* Is the last of the elements below `i`, or `i` itself? */
static int above_last(const struct solve *s, uint32_t i, uint32_t last)
{
    while (last != i && last != s->hierarchy.elements[last].parent)
        last = s->hierarchy.elements[last].parent;
    return last == i;
}

/* Mended as links say, but for one quarter: its siblings stay, and what is above them; the others
 * go, and light is what it was. Where a solid stands on a part, quarters stay. */
START_TEST(test_merge)
{
    struct scene scene;
    struct solve s;
    furnished_linear(&s, &scene, coarse, furnished_glows[_i], 1);
    uint32_t faces = s.hierarchy.face_count, before = s.hierarchy.count;
    ck_assert_int_eq(detail_leaves(&s, 1000000), 0);
    uint32_t count = s.hierarchy.count, odd = count;
    while (!is_bare(&s, odd - 1) || !(s.state.radiosity[odd - 1] > 0))
        odd--;
    odd--;
    s.mended.radiosity = copied(s.state.radiosity, count);
    s.mended.irradiance = copied(s.state.irradiance, count);
    s.mended_gradient = copied(s.linear.gradient, 3 * (size_t)count);
    s.mended.radiosity[odd] *= 1.01;
    uint64_t id = s.hierarchy.elements[odd].id;
    double(*p)[3] = malloc(faces * sizeof *p), *light = malloc(faces * sizeof *light);
    double marked = s.mended.radiosity[odd];
    look_at_faces(&s, p, light);
    ck_assert_int_eq(detail_merge(&s, before), 0);
    ck_assert_uint_lt(s.hierarchy.count, count);
    ck_assert_uint_eq(s.started, s.hierarchy.count);
    const struct element *elements = s.hierarchy.elements;
    uint32_t found = 0;
    for (uint32_t i = before; i < s.hierarchy.count; i++)
        if (elements[i].id == id)
            found = i;
    ck_assert_uint_gt(found, 0);
    ck_assert_double_eq(s.mended.radiosity[found], marked);
    for (uint32_t i = 1; i < s.hierarchy.count; i++) {
        const struct element *e = &elements[i], *parent = &elements[e->parent];
        ck_assert_uint_lt(e->parent, i);
        ck_assert(parent->child <= i && i < parent->child + parent->children);
        if (i >= before && is_bare(&s, i))
            ck_assert_msg(above_last(&s, e->parent, found), "element %u says nothing", i);
    }
    for (uint32_t f = 0; f < faces; f++)
        ck_assert_double_eq_tol(light_at(&s, f, p[f]), light[f], DETAIL_SAYS * light[f] + 1e-12);
    free(p);
    free(light);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* Places are looked at on finer leaves, which are gone afterwards. */
START_TEST(test_places)
{
    struct scene scene;
    struct solve s;
    struct ray_split split;
    const char *cause;
    furnished_linear(&s, &scene, coarse, furnished_glows[_i], 1);
    uint32_t elements = s.hierarchy.count;
    size_t bytes = elements * sizeof *s.hierarchy.elements;
    struct element *before = malloc(bytes);
    double *light = malloc(elements * sizeof *light);
    memcpy(before, s.hierarchy.elements, bytes);
    memcpy(light, s.state.irradiance, elements * sizeof *light);
    ck_assert_int_eq(detail_places(&s), 0);
    for (uint32_t i = 0; i < s.hierarchy.count; i++) {
        const struct element *e = &s.hierarchy.elements[i];
        if (e->vertices && !e->children && !e->black)
            ck_assert_double_le(e->area, PLACE_SHARE * s.hierarchy.elements[0].area);
    }
    ck_assert_int_eq(detail_drop(&s, elements), 0);
    ck_assert_int_eq(measure_places(&s, 20000, &split, &cause), 0);
    ck_assert_double_gt(split.ray, 0);
    ck_assert_uint_eq(s.hierarchy.count, elements);
    for (uint32_t i = 0; i < elements; i++)
        ck_assert_uint_eq(s.hierarchy.elements[i].children, before[i].children);
    ck_assert_int_eq(memcmp(light, s.state.irradiance, elements * sizeof *light), 0);
    free(before);
    free(light);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("detail");
    TCase *tests = tcase_create("");
    tcase_set_timeout(tests, 60);
    tcase_add_loop_test(tests, test_detail, 0, FURNISHED_GLOWS);
    tcase_add_test(tests, test_most_leaves);
    tcase_add_test(tests, test_worth);
    tcase_add_loop_test(tests, test_merge, 0, FURNISHED_GLOWS);
    tcase_add_loop_test(tests, test_places, 0, FURNISHED_GLOWS);
    suite_add_tcase(suite, tests);
    return suite_failures(suite) > 0;
}
