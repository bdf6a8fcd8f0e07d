/* check_smoothing.c - is noise taken off what vertices show, and nothing else?
 *
 * A square is cut evenly, and finer in one corner; values at its vertices are functions with noise
 * of a known size added, so that the right answer is known.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include "hierarchy/hierarchy.h"
#include "kernel/hash.h"
#include "output/smoothing.h"
#include "suite.h"

enum { EVENLY = 6, FINER = 3 };

struct square {
    struct RadFace face;
    struct RadMaterial material;
    struct hierarchy h;
    struct solution solution;
    struct vertex_values values;
    double *radiosity, *noise;
};

static struct square *square_open(void)
{
    static const double corner[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    struct square *s = calloc(1, sizeof *s);
    memcpy(s->face.vertex, corner, sizeof corner);
    s->face.vertices = 4;
    s->solution.surfaces =
        (struct surfaces){.faces = &s->face, .materials = &s->material, .face_count = 1};
    ck_assert_int_eq(hierarchy_build(&s->h, (const struct face *)(const void *)&s->face, 1), 0);
    for (int round = 0; round < EVENLY + FINER; round++)
        for (uint32_t i = 0, count = s->h.count; i < count; i++) {
            const struct element *e = &s->h.elements[i];
            const int near = e->centre[0] < 0.3 && e->centre[1] < 0.2;
            if (is_leaf(e) && (round < EVENLY || near))
                ck_assert_int_eq(hierarchy_split(&s->h, i), 0);
        }
    s->radiosity = calloc(s->h.count, sizeof *s->radiosity);
    s->solution.tree = (struct RadElements){.elements = s->h.elements,
                                            .count = s->h.count,
                                            .built = s->h.built,
                                            .face_element = s->h.face_element,
                                            .bands = 1,
                                            .radiosity = s->radiosity,
                                            .irradiance = s->radiosity};
    ck_assert_int_eq(vertex_values_build(&s->values, &s->solution), 0);
    s->noise = calloc(s->values.count, sizeof *s->noise);
    return s;
}

static void square_close(struct square *s)
{
    vertex_values_free(&s->values);
    hierarchy_free(&s->h);
    free(s->radiosity);
    free(s->noise);
    free(s);
}

static double linear(const double p[3])
{
    return 3 + 2 * p[0] - p[1];
}

static double step(const double p[3])
{
    return p[0] < 0.5 ? 1 : 3;
}

/* Of mean 0 and deviation 1. */
static double chance(uint64_t number)
{
    return sqrt(12) * (hash_unit(number * HASH_STEP) - 0.5);
}

/* The function, with that much noise. */
static void set(struct square *s, double (*function)(const double p[3]), double noise)
{
    for (uint32_t i = 0; i < s->values.count; i++) {
        s->values.value[i] =
            function(s->values.vertices[i].position) + noise * chance(2 * (uint64_t)i + 1);
        s->noise[i] = noise * chance(2 * (uint64_t)i + 2);
    }
}

/* How far the values are off, root mean square; *most: where they are off most, at vertices so far
 * from the middle at the least. */
static double off(const struct square *s, double (*function)(const double p[3]), double from,
                  double *most)
{
    double sum = 0;
    *most = 0;
    for (uint32_t i = 0; i < s->values.count; i++) {
        const double *p = s->values.vertices[i].position, d = s->values.value[i] - function(p);
        sum += d * d;
        if (fabs(p[0] - 0.5) >= from)
            *most = fmax(*most, fabs(d));
    }
    return sqrt(sum / s->values.count);
}

/* What is linear stays, however noisy it is said to be, also on borders and where large leaves meet
 * small ones. */
START_TEST(test_linear)
{
    struct square *s = square_open();
    double most;
    ck_assert_uint_gt(s->values.count, 5000);
    set(s, linear, 0);
    for (uint32_t i = 0; i < s->values.count; i++)
        s->noise[i] = chance(i);
    ck_assert_int_eq(smoothing_apply(&s->values, &s->solution, s->noise), 0);
    off(s, linear, 0, &most);
    ck_assert_double_lt(most, 1e-12);
    square_close(s);
}
END_TEST

/* Noise on it goes, all but a sixth. */
START_TEST(test_noise)
{
    struct square *s = square_open();
    double most;
    set(s, linear, 0.1);
    const double before = off(s, linear, 0, &most);
    ck_assert_double_eq_tol(before, 0.1, 0.005);
    ck_assert_int_eq(smoothing_apply(&s->values, &s->solution, s->noise), 0);
    ck_assert_double_lt(off(s, linear, 0, &most), before / 6);
    square_close(s);
}
END_TEST

/* An edge stays where it is, and as steep; away from it noise is less than half. */
START_TEST(test_edge)
{
    struct square *s = square_open();
    double before, after;
    set(s, step, 0.02);
    off(s, step, 0.25, &before);
    ck_assert_int_eq(smoothing_apply(&s->values, &s->solution, s->noise), 0);
    ck_assert_double_lt(off(s, step, 0.25, &after), 0.02);
    ck_assert_double_lt(after, 0.75 * before);
    off(s, step, 0, &after);
    ck_assert_double_lt(after, 0.1);
    square_close(s);
}
END_TEST

/* Vertices that nothing is known of stay, and nothing of them gets into others. */
START_TEST(test_unknown)
{
    struct square *s = square_open();
    set(s, linear, 0);
    for (uint32_t i = 0; i < s->values.count; i++) {
        s->noise[i] = hash64(i) % 8 == 0 ? NAN : chance(i);
        s->values.value[i] += isnan(s->noise[i]) ? 1000 : 0;
    }
    ck_assert_int_eq(smoothing_apply(&s->values, &s->solution, s->noise), 0);
    for (uint32_t i = 0; i < s->values.count; i++) {
        const double is = linear(s->values.vertices[i].position) + (isnan(s->noise[i]) ? 1000 : 0);
        ck_assert_double_eq_tol(s->values.value[i], is, 1e-9);
    }
    square_close(s);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("smoothing");
    TCase *tests = tcase_create("");
    tcase_set_timeout(tests, 60);
    tcase_add_test(tests, test_linear);
    tcase_add_test(tests, test_noise);
    tcase_add_test(tests, test_edge);
    tcase_add_test(tests, test_unknown);
    suite_add_tcase(suite, tests);
    return suite_failures(suite) > 0;
}
