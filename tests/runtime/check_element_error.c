/* check_element_error.c - what is said of the errors of elements, against errors that are known.
 *
 * In a furnace the truth is known at every place (make_known.h), so a solution is right, or off by
 * what a test takes off or adds on a part of one face.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <stdlib.h>
#include "runtime/make_known.h"
#include "runtime/make_solve.h"
#include "engine/measured_error.h"
#include "scene/read_scene.h"
#include "support/scene/read_scene.h"
#include "suite.h"

struct right {
    struct scene scene;
    struct solve solve;
    double *truth; /* H by face and band (W/m2) */
};

/* Elements as links want them, the light as it truly is. */
static void open_right(struct right *x, enum known kind, uint64_t seed)
{
    struct chance chance = {seed};
    char *settings[] = {NULL};
    x->truth = known_open(&x->scene, kind, &chance);
    solve_with(&x->solve, &x->scene, "bf", RELEASE_FLAT, settings, quick(1));
    const struct hierarchy *h = &x->solve.hierarchy;
    for (uint32_t e = 0; e < h->count; e++)
        for (uint32_t k = 0; k < x->scene.bands; k++)
            x->solve.state.irradiance[e * x->scene.bands + k] =
                x->truth[h->elements[e].face * x->scene.bands + k];
}

static void close_right(struct right *x)
{
    free(x->truth);
    solve_close(&x->solve);
    made_close(&x->scene);
}

static void measure(struct right *x, uint64_t rays, uint64_t stream, struct measured_error *m)
{
    const char *cause;
    ck_assert_int_eq(measure_error(&x->solve, rays, stream, 0, m, &cause), 0);
    ck_assert_int_eq(measured_elements(&x->solve, m), 0);
}

static int is_leaf(const struct hierarchy *h, uint32_t e)
{
    return h->elements[e].vertices && !h->elements[e].children;
}

/* How much of the surfaces is said to be off. */
static double coloured(const struct right *x, const struct measured_error *m)
{
    const struct hierarchy *h = &x->solve.hierarchy;
    double area = 0;
    for (uint32_t e = 0; e < h->count; e++)
        for (uint32_t k = 0; k < x->scene.bands; k++)
            if (is_leaf(h, e) && m->elements.error[e * x->scene.bands + k] != 0)
                area += h->elements[e].area / x->scene.bands;
    return area / h->elements[0].area;
}

/* Where nothing is wrong, nothing is said to be: of twenty measurements one may say so by chance.
 * Few particles or many, three of a leaf or a hundred. */
START_TEST(test_right)
{
    static const enum known kinds[] = {KNOWN_BOX, KNOWN_FURNISHED, KNOWN_SCREEN, KNOWN_PRISM};
    static const uint64_t rays[] = {3000, 30000, 200000};
    int streams = thorough() ? 60 : 8, trials = 0, wrong = 0;
    for (int kind = 0; kind < 4; kind++)
        for (uint64_t seed = 1; seed <= 3; seed++) {
            struct right x;
            open_right(&x, kinds[kind], seed);
            for (int i = 0; i < (thorough() ? 3 : 2); i++)
                for (int j = 0; j < streams; j++) {
                    struct measured_error m;
                    measure(&x, rays[i], 1 + (uint64_t)j, &m);
                    trials++;
                    wrong += coloured(&x, &m) > 0;
                    measured_error_free(&m);
                }
            close_right(&x);
        }
    if (thorough())
        printf("%d of %d measurements see an error where none is\n", wrong, trials);
    ck_assert_int_le(wrong, (int)(0.05 * trials + 3 * sqrt(0.05 * 0.95 * trials)));
}
END_TEST

/* ---- errors that are there */

/* Is an element in that part of the tree? */
static int is_below(const struct hierarchy *h, uint32_t e, uint32_t top)
{
    while (e > top && h->elements[e].depth > h->elements[top].depth)
        e = h->elements[e].parent;
    return e == top;
}

/* Take so much of the light from a part of the tree, or add it. */
static void spoil(struct right *x, uint32_t top, double share)
{
    for (uint32_t e = top; e < x->solve.hierarchy.count; e++)
        for (uint32_t k = 0; k < x->scene.bands && is_below(&x->solve.hierarchy, e, top); k++)
            x->solve.state.irradiance[e * x->scene.bands + k] *= 1 + share;
}

/* What is told of leaves: how much of the area of some is said to be off, by which share of what
 * they truly reflect in the mean, how far a leaf is from `share`, and how many limits are too low.
 */
struct told {
    double area, share, most;
    int missed, leaves;
};

static struct told told_of(const struct right *x, const struct measured_error *m, uint32_t top,
                           int below, double share)
{
    const struct hierarchy *h = &x->solve.hierarchy;
    struct told t = {0, 0, 0, 0, 0};
    double all = 0, reflected = 0;
    for (uint32_t e = 0; e < h->count; e++) {
        uint32_t face = h->elements[e].face;
        double area = h->elements[e].area;
        if (!is_leaf(h, e) || is_below(h, e, top) != below)
            continue;
        for (uint32_t k = 0; k < x->scene.bands; k++) {
            size_t i = e * x->scene.bands + k;
            double truth = x->solve.problem.reflectance[face * x->scene.bands + k]
                           * x->truth[face * x->scene.bands + k];
            t.area += m->elements.error[i] != 0 ? area : 0;
            t.share += area * m->elements.error[i];
            t.most = fmax(t.most, fabs(m->elements.error[i] / truth - share));
            t.missed += m->elements.limit[i] < fabs(share) * truth;
            t.leaves++;
            reflected += area * truth;
            all += area;
        }
    }
    t.area /= all;
    t.share /= reflected;
    return t;
}

/* A whole face, or a quarter of it, that is too bright or too dark, or has no light at all: that is
 * told of it, by about how much, the same of all its leaves, and of nothing else. */
START_TEST(test_wrong)
{
    static const double shares[] = {0.17, -0.17, 1, -1};
    for (int i = 0; i < 4; i++)
        for (int quarter = 0; quarter < 2; quarter++) {
            struct right x;
            struct measured_error m;
            open_right(&x, KNOWN_BOX, 5);
            const struct hierarchy *h = &x.solve.hierarchy;
            uint32_t top = h->face_element[2];
            ck_assert_uint_eq(h->elements[top].children, 4);
            top = quarter ? h->elements[top].child + 1 : top;
            spoil(&x, top, shares[i]);
            measure(&x, 200000, 7, &m);
            struct told off = told_of(&x, &m, top, 1, shares[i]),
                        other = told_of(&x, &m, top, 0, 0);
            ck_assert_double_eq(off.area, 1);
            ck_assert_double_eq_tol(off.share, shares[i], 0.04);
            ck_assert_double_le(off.most, 0.05);
            ck_assert_double_eq(other.area, 0);
            measured_error_free(&m);
            close_right(&x);
        }
}
END_TEST

/* An error as large as its noise is: of forty limits of a face one is too low, as a rule; and they
 * are no wider than a few times the noise. */
START_TEST(test_limits)
{
    struct right x;
    int missed = 0, leaves = 0, wide = 0, streams = thorough() ? 400 : 60;
    open_right(&x, KNOWN_BOX, 5);
    uint32_t top = x.solve.hierarchy.face_element[2];
    spoil(&x, top, 0.05);
    for (int i = 0; i < streams; i++) {
        struct measured_error m;
        measure(&x, 10000, 1 + (uint64_t)i, &m);
        struct told low = told_of(&x, &m, top, 1, 0.05), high = told_of(&x, &m, top, 1, 0.25);
        missed += low.missed;
        wide += high.leaves - high.missed;
        leaves += low.leaves;
        measured_error_free(&m);
    }
    ck_assert_double_le(missed, (0.05 + 3 * sqrt(0.025 / streams)) * leaves);
    ck_assert_double_le(wide, 0.1 * leaves);
    close_right(&x);
}
END_TEST

/* A face that is right in the mean, half of it too bright and half too dark: both are told. */
START_TEST(test_cancelling)
{
    struct right x;
    struct measured_error m;
    open_right(&x, KNOWN_BOX, 5);
    const struct hierarchy *h = &x.solve.hierarchy;
    uint32_t face = h->face_element[2], first = h->elements[face].child;
    for (uint32_t c = 0; c < 4; c++)
        spoil(&x, first + c, c < 2 ? 0.3 : -0.3);
    measure(&x, 200000, 7, &m);
    for (uint32_t c = 0; c < 4; c++) {
        double share = c < 2 ? 0.3 : -0.3;
        struct told t = told_of(&x, &m, first + c, 1, share);
        ck_assert_double_eq(t.area, 1);
        ck_assert_double_eq_tol(t.share, share, 0.05);
    }
    ck_assert_double_eq(told_of(&x, &m, face, 0, 0).area, 0);
    measured_error_free(&m);
    close_right(&x);
}
END_TEST

/* The room whose lamps a plain oracle lets shine on the ceiling: too bright nearly everywhere, and
 * said to be so by as few particles as measure by default, in the mean over several draws. */
START_TEST(test_panels)
{
    const struct solve_options options = {.tolerance = 1e-3, .iterations = 1000, .threads = 2};
    const struct scene_options how = {.quiet = 1};
    struct right x;
    struct measured_error m;
    double bright = 0, dark = 0, all = 0;
    ck_assert_int_eq(scene_read(&x.scene, "tests/runtime/panels.obj", &how), 0);
    solve_with(&x.solve, &x.scene, "bf_guarded", RELEASE_FLAT, NULL, options);
    const struct hierarchy *h = &x.solve.hierarchy;
    for (uint64_t stream = 1; stream <= 6; stream++) {
        measure(&x, 1 << 15, stream, &m);
        for (uint32_t e = 0; e < h->count; e++) {
            const size_t at = (size_t)e * x.scene.bands;
            uint32_t face = h->elements[e].face;
            if (!is_leaf(h, e) || !(x.solve.state.irradiance[at] > 0)
                || !(x.solve.problem.reflectance[(size_t)face * x.scene.bands] > 0))
                continue;
            all += h->elements[e].area;
            bright += m.elements.error[at] > 0 ? h->elements[e].area : 0;
            dark += m.elements.error[at] < 0 ? h->elements[e].area : 0;
        }
        measured_error_free(&m);
    }
    ck_assert_double_ge(bright, 0.8 * all);
    ck_assert_double_le(dark, 0.01 * all);
    solve_close(&x.solve);
    scene_free(&x.scene);
}
END_TEST

/* The large face that is most surely wrong is so rarely wrongly told, of one band and of three,
 * whose noise is the same particles'; and where it is told, its leaves are, too. */
START_TEST(test_worst)
{
    int wrong[4] = {0}, trials[4] = {0}, streams = thorough() ? 200 : 30;
    for (uint64_t seed = 1; seed <= 6; seed++) {
        struct right x;
        open_right(&x, KNOWN_BOX, seed);
        for (int i = 0; i < streams; i++) {
            struct measured_error m;
            measure(&x, 3000, 1 + (uint64_t)i, &m);
            trials[x.scene.bands]++;
            if (m.faces.worst < m.faces.polygons) {
                wrong[x.scene.bands]++;
                ck_assert_double_gt(coloured(&x, &m), 0);
            }
            measured_error_free(&m);
        }
        close_right(&x);
    }
    for (int bands = 1; bands <= 3; bands += 2) {
        ck_assert_int_gt(trials[bands], 0);
        ck_assert_int_le(wrong[bands],
                         (int)(0.05 * trials[bands] + 3 * sqrt(0.05 * trials[bands])));
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("element_error");
    TCase *t = tcase_create("element_error");
    tcase_set_timeout(t, 300);
    tcase_add_test(t, test_right);
    tcase_add_test(t, test_wrong);
    tcase_add_test(t, test_limits);
    tcase_add_test(t, test_cancelling);
    tcase_add_test(t, test_panels);
    tcase_add_test(t, test_worst);
    suite_add_tcase(suite, t);
    return suite_failures(suite) ? EXIT_FAILURE : EXIT_SUCCESS;
}
