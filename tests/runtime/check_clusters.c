/* check_clusters.c - links between groups of faces: they must change little, in small scenes
 * and in large ones, and leak nothing.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "scene/make_scene.h"
#include "util/oracles.h"
#include "engine/solve.h"
#include "suite.h"

/* The parallelogram o, a, b as n x n faces. */
static void grid(struct scene *s, uint32_t material, int n, const double o[3], const double a[3],
                 const double b[3])
{
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            made_quad(s, material, o[0] + (i * a[0] + j * b[0]) / n,
                      o[1] + (i * a[1] + j * b[1]) / n, o[2] + (i * a[2] + j * b[2]) / n, a[0] / n,
                      a[1] / n, a[2] / n, b[0] / n, b[1] / n, b[2] / n);
}

/* A box, seen from inside or from outside, each side n x n faces. */
static void box(struct scene *s, uint32_t material, int n, double x, double y, double z, double sx,
                double sy, double sz, int outside)
{
    const double o[3] = {x, y, z}, p[3] = {x + sx, y + sy, z + sz};
    const double u[3][3] = {{sx, 0, 0}, {0, sy, 0}, {0, 0, sz}},
                 w[3][3] = {{-sx, 0, 0}, {0, -sy, 0}, {0, 0, -sz}};
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        grid(s, material, n, o, outside ? u[j] : u[i], outside ? u[i] : u[j]);
        grid(s, material, n, p, outside ? w[i] : w[j], outside ? w[j] : w[i]);
    }
}

static struct solve *released(struct solve *s, const struct scene *scene, const char *oracle,
                              enum release release, int threads, enum closure closure,
                              const char *set)
{
    struct solve_options how = {
        .tolerance = 1e-5, .iterations = 2000, .threads = threads, .closure = closure};
    struct refiner *r = oracles_open(oracle, release);
    char setting[64];
    char *settings[1] = {setting};
    ck_assert_ptr_nonnull(r);
    snprintf(setting, sizeof setting, "%s", set ? set : "");
    ck_assert_int_eq(oracles_set(r, settings, set != NULL), 0);
    const char *cause;
    ck_assert_int_eq(solve_open(s, scene, &how, &cause), 0);
    ck_assert_int_eq(solve_run(s, r, &cause), 0);
    refiner_close(r);
    return s;
}

static struct solve *solved(struct solve *s, const struct scene *scene, const char *oracle,
                            int threads, enum closure closure, const char *set)
{
    return released(s, scene, oracle, RELEASE_FLAT, threads, closure, set);
}

static size_t group_links(const struct solve *s)
{
    size_t n = 0;
    for (size_t i = 0; i < s->refinement.link_count; i++)
        n += !s->hierarchy.elements[s->refinement.links[i].receiver].vertices
             || !s->hierarchy.elements[s->refinement.links[i].emitter].vertices;
    return n;
}

static double face_value(const struct solve *s, uint32_t face)
{
    return s->state.radiosity[(size_t)s->hierarchy.face_element[face] * s->problem.bands];
}

/* sum A |B - B'| / sum A B' over faces */
static double difference(const struct solve *s, const struct solve *t)
{
    double off = 0, all = 0;
    for (uint32_t i = 0; i < s->problem.scene->face_count; i++) {
        double a = hierarchy_surface(&s->hierarchy, i)->area;
        off += a * fabs(face_value(s, i) - face_value(t, i));
        all += a * face_value(t, i);
    }
    return off / all;
}

/* A room of 4 x 3 x 2.5 with a lamp below the ceiling and two boxes on the floor; `n` sets how
 * finely all is cut. */
static void room(struct scene *s, int n)
{
    ck_assert_int_eq(made_open(s), 0);
    made_material(s, 0.6, 0);
    made_material(s, 0.3, 0);
    made_material(s, 0, 40);
    box(s, 0, n, 0, 0, 0, 4, 3, 2.5, 0);
    box(s, 1, n, 0.7, 0.6, 0, 0.8, 0.6, 0.9, 1);
    box(s, 1, n, 2.5, 1.6, 0, 0.5, 0.7, 1.4, 1);
    made_quad(s, 2, 1.8, 1.2, 2.4, 0, 0.5, 0, 0.5, 0, 0);
}

/* In a scene of few faces: groups are linked, and give the same light, nearly. */
START_TEST(test_small)
{
    struct solve a, b;
    struct scene scene;
    room(&scene, 3);
    ck_assert(scene.face_count > 150 && scene.face_count < 1500);
    const char *setting = thorough() ? NULL : "min_share=1.2e-4";
    solved(&a, &scene, "clusters", 2, CLOSURE_NONE, setting);
    solved(&b, &scene, "bf_guarded", 2, CLOSURE_NONE, thorough() ? NULL : "min_share=3e-4");
    printf("room of %u faces: %zu links, %zu of them of clusters; %zu without; B differs by %.2g\n",
           scene.face_count, a.refinement.link_count, group_links(&a), b.refinement.link_count,
           difference(&a, &b));
    ck_assert_uint_gt(group_links(&a), 1000);
    ck_assert_uint_eq(group_links(&b), 0);
    ck_assert_double_le(difference(&a, &b), 0.015);
    solve_close(&a);
    solve_close(&b);
    made_close(&scene);
}
END_TEST

/* All that a solve says, to the bit. */
static void assert_same(const struct solve *a, const struct solve *b)
{
    const struct refinement *r = &a->refinement, *other = &b->refinement;
    const struct row_report *rows = &a->report.rows, *others = &b->report.rows;
    size_t elements = a->hierarchy.count, values = elements * a->problem.bands;
    ck_assert_uint_eq(elements, b->hierarchy.count);
    ck_assert_uint_eq(r->link_count, other->link_count);
    ck_assert_int_eq(memcmp(r->links, other->links, r->link_count * sizeof *r->links), 0);
    ck_assert_int_eq(
        memcmp(r->first_link, other->first_link, (elements + 1) * sizeof *r->first_link), 0);
    ck_assert_int_eq(memcmp(r->marked, other->marked, sizeof r->marked), 0);
    ck_assert_int_eq(memcmp(a->state.radiosity, b->state.radiosity, values * sizeof(double)), 0);
    for (size_t i = 0; i < elements; i++) /* rows are leaves' */
        if (a->hierarchy.elements[i].vertices && !a->hierarchy.elements[i].children)
            ck_assert_int_eq(memcmp(&a->operator.row[i], &b->operator.row[i], sizeof(double)), 0);
    ck_assert(!(rows->low < others->low) && !(rows->low > others->low));
    ck_assert(!(rows->high < others->high) && !(rows->high > others->high));
    ck_assert_uint_eq(rows->leaves, others->leaves);
    const double mine[] = {rows->defect_mean, rows->defect_most, rows->blind_area, rows->moved},
                 its[] = {others->defect_mean, others->defect_most, others->blind_area,
                          others->moved};
    ck_assert_int_eq(memcmp(mine, its, sizeof mine), 0);
}

/* Links as they were found, in their order, behind each other by receiver. */
START_TEST(test_sorted)
{
    enum { ELEMENTS = 300, LINKS = 20000 };
    for (int threads = 1; threads <= 11; threads += 2)
        for (size_t count = 0; count <= LINKS; count = count < 3 ? count + 1 : count * 7 + 1) {
            struct hierarchy h = {.count = ELEMENTS};
            struct refinement r = {.hierarchy = &h, .threads = threads, .link_count = count};
            r.links = calloc(count + 1, sizeof *r.links);
            for (size_t i = 0; i < count; i++)
                r.links[i] = (struct link){.receiver = (uint32_t)(i * i * 7919 % ELEMENTS),
                                           .emitter = (uint32_t)i,
                                           .mark = (uint8_t)(i % LINK_MARKS)};
            ck_assert_int_eq(refinement_sort(&r), 0);
            size_t at = 0;
            for (uint32_t e = 0; e < ELEMENTS; e++) {
                ck_assert_uint_eq(r.first_link[e], at);
                for (; at < count && r.links[at].receiver == e; at++)
                    ck_assert(at == r.first_link[e]
                              || r.links[at].emitter > r.links[at - 1].emitter);
            }
            ck_assert_uint_eq(at, count);
            ck_assert_uint_eq(r.first_link[ELEMENTS], count);
            for (size_t m = 0; m < LINK_MARKS; m++)
                ck_assert_uint_eq(r.marked[m], (count + LINK_MARKS - 1 - m) / LINK_MARKS);
            refinement_close(&r);
        }
}
END_TEST

/* In a scene of many faces: fewer links, and nearly the same light. The same whatever the threads
 * and the release. */
START_TEST(test_large)
{
    struct solve with, without, one;
    struct scene scene;
    room(&scene, 10);
    ck_assert_uint_gt(scene.face_count, 1500);
    const char *setting = thorough() ? NULL : "min_share=1.2e-4";
    solved(&with, &scene, "clusters", 5, CLOSURE_NONE, setting);
    released(&one, &scene, "clusters", RELEASE_DAG, 1, CLOSURE_NONE, setting);
    solved(&without, &scene, "bf_guarded", 2, CLOSURE_NONE, thorough() ? NULL : "min_share=3e-4");
    printf("room of %u faces: %zu links, %zu of them of clusters; %zu without; B differs by %.2g; "
           "power lost %.2g\n",
           scene.face_count, with.refinement.link_count, group_links(&with),
           without.refinement.link_count, difference(&with, &without),
           1 - with.report.absorbed / with.report.emitted);
    ck_assert_uint_gt(group_links(&with), 1000);
    ck_assert_uint_lt(2 * with.refinement.link_count, without.refinement.link_count);
    ck_assert_double_le(difference(&with, &without), 0.015);
    ck_assert_double_le(fabs(1 - with.report.absorbed / with.report.emitted), 0.03);
    assert_same(&with, &one);
    solve_close(&with);
    solve_close(&one);
    solve_close(&without);
    made_close(&scene);
}
END_TEST

/* Fog loses some of the light, shadows that are averaged misplace some: near what clusters
 * finds, but no nearer. */
START_TEST(test_feature)
{
    struct solve fog, one, rays;
    struct scene scene;
    room(&scene, 10);
    solved(&fog, &scene, "clusters_feature", 2, CLOSURE_NONE, "min_share=5e-4");
    released(&one, &scene, "clusters_feature", RELEASE_DAG, 1, CLOSURE_NONE, "min_share=5e-4");
    solved(&rays, &scene, "clusters", 2, CLOSURE_NONE, "min_share=2e-4");
    printf("room of %u faces through fog: %zu links, %zu of them of clusters; B differs by %.2g; "
           "power lost %.2g\n",
           scene.face_count, fog.refinement.link_count, group_links(&fog), difference(&fog, &rays),
           1 - fog.report.absorbed / fog.report.emitted);
    ck_assert_uint_gt(group_links(&fog), 1000);
    ck_assert_double_le(difference(&fog, &rays), 0.1);
    ck_assert_double_le(fabs(1 - fog.report.absorbed / fog.report.emitted), 0.1);
    ck_assert_uint_eq(fog.refinement.link_count, one.refinement.link_count);
    ck_assert_int_eq(memcmp(fog.refinement.links, one.refinement.links,
                            one.refinement.link_count * sizeof *one.refinement.links),
                     0);
    solve_close(&fog);
    solve_close(&one);
    solve_close(&rays);
    made_close(&scene);
}
END_TEST

/* White furnace: B = E / (1 - rho) everywhere, whatever stands in it. Closing rows makes it
 * exact. */
START_TEST(test_furnace)
{
    struct scene scene;
    double worst[2], mean[2], gain[2];
    for (int closure = 0; closure < 2; closure++) {
        double all = 0;
        ck_assert_int_eq(made_open(&scene), 0);
        made_material(&scene, 0.5, 1);
        box(&scene, 0, 15, 0, 0, 0, 1, 1, 1, 0);
        box(&scene, 0, 6, 0.3, 0.35, 0.2, 0.3, 0.3, 0.3, 1);
        struct solve s;
        solved(&s, &scene, "clusters", 2, closure ? CLOSURE_ROWS : CLOSURE_NONE, NULL);
        ck_assert_uint_gt(group_links(&s), 1000);
        worst[closure] = mean[closure] = gain[closure] = 0;
        for (uint32_t i = 0; i < scene.face_count; i++) {
            double off = fabs(face_value(&s, i) / 2 - 1),
                   a = hierarchy_surface(&s.hierarchy, i)->area;
            worst[closure] = off > worst[closure] ? off : worst[closure];
            mean[closure] += a * off;
            gain[closure] += a * (face_value(&s, i) / 2 - 1);
            all += a;
        }
        mean[closure] /= all;
        gain[closure] /= all;
        printf("furnace with a box, %s: B off by %.2g in the mean (%+.2g with its sign), %.2g at "
               "the worst face\n",
               closure ? "rows closed" : "as it is", mean[closure], gain[closure], worst[closure]);
        solve_close(&s);
        made_close(&scene);
    }
    ck_assert_double_le(mean[0], 0.01);
    ck_assert_double_le(fabs(gain[0]), 0.005);
    ck_assert_double_le(worst[0], 0.15);
    ck_assert_double_le(worst[1], 1e-4);
}
END_TEST

/* Two rooms behind a wall, a lamp in the first: no light in the second, though groups of faces
 * span both. */
START_TEST(test_leak)
{
    struct scene scene;
    uint32_t dark = 0;
    ck_assert_int_eq(made_open(&scene), 0);
    made_material(&scene, 0.7, 0);
    made_material(&scene, 0.7, 1);
    box(&scene, 1, 12, 0, 0, 0, 1, 1, 1, 0);
    box(&scene, 0, 12, 1.001, 0, 0, 1, 1, 1, 0);
    struct solve s;
    solved(&s, &scene, "clusters", 2, CLOSURE_NONE, NULL);
    for (uint32_t i = 0; i < scene.face_count; i++)
        if (scene.faces[i].material == 0) {
            dark++;
            ck_assert(face_value(&s, i) <= 0);
        }
    ck_assert_uint_eq(dark, 864);
    ck_assert_uint_gt(group_links(&s), 1000);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* A lamp far above a plate of many faces that is black underneath (0), and above two of them, one
 * above the other (1). The upper side gets the light of a lamp taken for a point, A B cos^2 / (pi
 * d^2): a group does not shade itself wrongly. Undersides are dark, and so is what lies in the
 * shadow of its own group. */
START_TEST(test_self_shadow)
{
    const double across[3] = {1, 0, 0}, along[3] = {0, 1, 0}, upper[3] = {0, 0, 0.1},
                 lower[3] = {0, 0, 0};
    struct scene scene;
    double got[3] = {0, 0, 0}, expected = 0, high = _i == 0 ? 8 : 1.6;
    ck_assert_int_eq(made_open(&scene), 0);
    made_material(&scene, 0.5, 0);
    made_material(&scene, 0.5, 0);
    made_material(&scene, 0.5, 0);
    made_material(&scene, 0, 1000);
    grid(&scene, 0, 24, upper, across, along);
    grid(&scene, 1, 24, upper, along, across);
    if (_i == 1)
        grid(&scene, 2, 24, lower, across, along);
    made_quad(&scene, 3, 0.49, 0.49, high, 0, 0.02, 0, 0.02, 0, 0);
    for (uint32_t i = 0; i < 24 * 24; i++) {
        double x = (i / 24 + 0.5) / 24 - 0.5, y = (i % 24 + 0.5) / 24 - 0.5, z = high - 0.1,
               square = x * x + y * y + z * z;
        expected += 1000 * 0.0004 * z * z / (3.14159265358979323846 * square * square) / (24 * 24);
    }
    struct solve s;
    solved(&s, &scene, "clusters", 2, CLOSURE_NONE, NULL);
    for (uint32_t i = 0; i < scene.face_count; i++)
        if (scene.faces[i].material < 3)
            got[scene.faces[i].material] +=
                s.state.irradiance[s.hierarchy.face_element[i]] / (24 * 24);
    printf("plates: %.4f of the lamp's light above, %.2g underneath, %.2g below; %zu links of "
           "groups\n",
           got[0] / expected, got[1] / expected, got[2] / expected, group_links(&s));
    ck_assert_double_eq_tol(got[0] / expected, 1, 0.02);
    ck_assert_double_le(got[1] / expected, _i == 0 ? 0 : 0.02);
    ck_assert_double_le(got[2] / expected, 0.02);
    ck_assert(_i == 1 || group_links(&s) > 0);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* Groups after Kok, linked by their size and their power alone, keep the power of a scene of many
 * small faces: a furnace of tiles with a box of tiles in it, where B is the same everywhere. */
START_TEST(test_kok_keeps_power)
{
    struct scene scene;
    made_open(&scene);
    uint32_t grey = made_material(&scene, 0.5, 0.5), white = made_material(&scene, 0.8, 0.2);
    box(&scene, grey, 12, 0, 0, 0, 4, 5, 3, 0);
    box(&scene, white, 8, 1.5, 2, 1, 1, 1, 1, 1);
    struct solve s;
    solved(&s, &scene, "kok", 2, CLOSURE_NONE, "relative=0.2");
    double sum = 0, off = 0, area = 0;
    for (uint32_t f = 0; f < scene.face_count; f++) {
        double a = hierarchy_surface(&s.hierarchy, f)->area;
        sum += a * face_value(&s, f);
        off += a * fabs(face_value(&s, f) - 1);
        area += a;
    }
    printf("kok: %u faces, %zu links, %zu of them of groups; B is %.4f in the mean, off by %.2g\n",
           scene.face_count, s.refinement.link_count, group_links(&s), sum / area, off / area);
    ck_assert_uint_gt(group_links(&s), s.refinement.link_count / 10);
    ck_assert_uint_lt(s.refinement.link_count, (size_t)scene.face_count * scene.face_count / 8);
    ck_assert_double_eq_tol(sum / area, 1, 0.01);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("clusters");
    TCase *c = tcase_create("clusters");
    tcase_set_timeout(c, 120);
    tcase_add_test(c, test_small);
    tcase_add_test(c, test_large);
    tcase_add_test(c, test_sorted);
    if (thorough())
        tcase_add_test(c, test_feature);
    tcase_add_test(c, test_furnace);
    tcase_add_test(c, test_leak);
    tcase_add_loop_test(c, test_self_shadow, 0, 2);
    tcase_add_test(c, test_kok_keeps_power);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
