/* check_ranking.c - links ranked by error times impact: what a watt is worth, by duality; that a
 * pass refines no more links than it may, the worst ones, up to the budget; and that it pays.
 * SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <stdlib.h>
#include "runtime/make_solve.h"
#include "runtime/path_reference.h"
#include "oracles.h"
#include "suite.h"

/* ---- impact */

/* sum A B = sum A Y E when every place counts alike, as far as A_i F_ij = A_j F_ji: and by one
 * element per face of a furnace Y is 1 / (1 - rho). */
START_TEST(test_impact)
{
    char *const settings[] = {(char *)"links=3000", NULL};
    struct scene scene;
    if (_i)
        furnished(&scene, 1);
    else
        furnace_cube(&scene, 0.8);
    struct solve s;
    solve_with(&s, &scene, "ranked", RELEASE_FLAT, settings, quick(2));
    double leaves = 0, worth = 0;
    for (uint32_t i = 0; i < s.hierarchy.count; i++) {
        const struct element *e = &s.hierarchy.elements[i];
        double area = e->area * s.operator.uncovered[i];
        if (!e->vertices || e->children || !(area > 0))
            continue;
        leaves += area * s.state.radiosity[i];
        worth += area * s.importance.value[i] * s.problem.exitance[e->face];
        if (!_i)
            ck_assert_double_eq_tol(s.importance.value[i], 1 / (1 - 0.8), 2e-3 / (1 - 0.8));
    }
    ck_assert_double_eq_tol(worth, leaves, 0.01 * leaves);
    ck_assert_double_eq(rays_host(s.problem.rays)->impact, s.importance.largest);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* ---- passes */

/* A link and what it was worth before a pass. */
struct before {
    uint32_t receiver, emitter;
    double priority;
    int kept;
};

static int has_link(const struct refinement *r, const struct before *b)
{
    for (size_t i = r->first_link[b->receiver]; i < r->first_link[b->receiver + 1]; i++)
        if (r->links[i].emitter == b->emitter)
            return 1;
    return 0;
}

/* Step by step: of the links there are, no more are split than the share allows, none of which was
 * better than one that stayed. */
START_TEST(test_worst_first)
{
    char *const settings[] = {(char *)"links=12000", (char *)"share=0.1", (char *)"relative=1e-6",
                              NULL};
    struct solve_options options = quick(2);
    struct scene scene;
    furnished(&scene, 1);
    struct refiner *r = oracles_open("ranked", RELEASE_FLAT);
    ck_assert(r && oracles_set(r, settings, 3) == 0);
    struct solve s;
    const char *cause;
    ck_assert_int_eq(solve_open(&s, &scene, &options, &cause), 0);
    ck_assert_int_eq(solve_refine(&s, r, &cause), 0);
    int more = 1, passes = 0;
    size_t first = s.refinement.link_count;
    while (more > 0) {
        size_t count = s.refinement.link_count, split = 0;
        struct before *before = malloc(count * sizeof *before);
        ck_assert_ptr_nonnull(before);
        for (size_t i = 0; i < count; i++)
            before[i] = (struct before){s.refinement.links[i].receiver,
                                        s.refinement.links[i].emitter, 0, 0};
        more = solve_step(&s, &cause);
        ck_assert_int_ge(more, 0);
        double least_split = INFINITY, most_kept = 0;
        for (size_t i = 0; i < count; i++) {
            before[i].priority = s.ranking.priority[i];
            before[i].kept = has_link(&s.refinement, &before[i]);
            if (before[i].kept)
                continue;
            split++;
            least_split = fmin(least_split, before[i].priority);
        }
        for (size_t i = 0; i < count; i++)
            if (before[i].kept)
                most_kept = fmax(most_kept, before[i].priority);
        ck_assert_uint_le(split, (size_t)fmax(1, 0.1 * (double)count));
        ck_assert_uint_le(s.refinement.link_count, 12000 + 3);
        /* a link that could not be split stays, whatever it is worth; it is marked, and once only
         * among the worst */
        if (split > 0 && s.refinement.marked[LINK_GUARDED] == 0)
            ck_assert_double_ge(least_split, most_kept);
        passes++;
        free(before);
    }
    printf("%d passes from %zu to %zu links\n", passes, first, s.refinement.link_count);
    ck_assert_int_gt(passes, 10);
    ck_assert_uint_gt(s.refinement.link_count, 11900);
    ck_assert_int_eq(s.report.converged, 1);
    solve_close(&s);
    refiner_close(r);
    made_close(&scene);
}
END_TEST

/* One link is split in a pass, for ever: step by step there are as many passes as at one go. */
START_TEST(test_last)
{
    char *const settings[] = {(char *)"share=1e-5", (char *)"relative=1e-9", NULL};
    struct solve_options options = quick(2);
    struct scene scene;
    struct solve s, t;
    const char *cause;
    furnished(&scene, 1);
    struct refiner *r = oracles_open("ranked", RELEASE_FLAT);
    ck_assert(r && oracles_set(r, settings, 2) == 0);
    ck_assert_int_eq(solve_open(&s, &scene, &options, &cause), 0);
    ck_assert_int_eq(solve_refine(&s, r, &cause), 0);
    int steps = 1;
    while (solve_step(&s, &cause) > 0 && steps < 1000)
        steps++;
    ck_assert_int_eq(s.report.converged, 0);
    ck_assert_int_eq(solve_open(&t, &scene, &options, &cause), 0);
    ck_assert_int_eq(solve_run(&t, r, &cause), 0);
    ck_assert_int_eq(t.report.passes, steps);
    ck_assert_int_eq(s.report.passes, steps);
    solve_close(&t);
    solve_close(&s);
    refiner_close(r);
    made_close(&scene);
}
END_TEST

/* Releases and threads decide alike, pass by pass. */
START_TEST(test_alike)
{
    char *const settings[] = {(char *)"links=6000", NULL};
    struct scene scene;
    furnished(&scene, 1);
    struct solve s, t;
    solve_with(&s, &scene, "ranked", RELEASE_FLAT, settings, quick(2));
    solve_with(&t, &scene, "ranked", _i ? RELEASE_DAG : RELEASE_FLAT, settings, quick(1));
    same_links(&s, &t);
    ck_assert_int_eq(s.report.passes, t.report.passes);
    solve_close(&s);
    solve_close(&t);
    made_close(&scene);
}
END_TEST

/* ---- what it is worth */

/* `ranked` without the ranking: refine what is above a threshold, as it comes; `%s`: that (W). */
static const char as_it_comes[] =
    "oracle unranked \"by error alone\" { start level;\n"
    "  node level = clusters() { surfaces -> planes;  apart -> stop;  receiver -> "
    "subdivide_receiver;  emitter -> subdivide_emitter; }\n"
    "  node planes = support_planes() { away -> stop;  otherwise -> light; }\n"
    "  node light = transfer() { dark -> stop;  below | above -> between; }\n"
    "  node between = shaft() { invisible -> stop;  visible | uncertain | too_complex -> rays; }\n"
    "  node rays = visibility(rays = 16) { none | partial | all -> wrong; }\n"
    "  node wrong = worst(watts = %s) { small -> form;  receiver -> cut_r;  emitter -> cut_s; }\n"
    "  node cut_r = can_split(min_share = 2e-5) { receiver | both -> subdivide_receiver;\n"
    "                                             emitter -> subdivide_emitter;  neither -> form; "
    "}\n"
    "  node cut_s = can_split(min_share = 2e-5) { emitter | both -> subdivide_emitter;\n"
    "                                             receiver -> subdivide_receiver;  neither -> "
    "form; }\n"
    "  node form = form_factor() { done -> link; }\n"
    "}\n";

/* sum rho A |H - H_ref| over sum rho A H_ref, faces. */
static double error_of(const struct solve *s, const double *reference)
{
    double wrong = 0, all = 0;
    for (uint32_t i = 0; i < s->problem.scene->face_count; i++) {
        uint32_t e = s->hierarchy.face_element[i];
        double by = s->problem.reflectance[i] * s->hierarchy.elements[e].area;
        wrong += by * fabs(s->state.irradiance[e] - reference[i]);
        all += by * reference[i];
    }
    return wrong / all;
}

/* With as many links as refinement of what is above a threshold makes, light is no more wrong. */
START_TEST(test_worth)
{
    static const char *const watts[] = {"0.1", "0.03", "0.01", "0.003"};
    struct scene scene;
    furnished(&scene, 1);
    for (int i = 0; i < 4; i++) /* else paths and links meet another one of the lamp's sides */
        scene.faces[7].vertex[i][2] += 0.01;
    double *reference = calloc(scene.face_count, sizeof *reference),
           *noise = calloc(scene.face_count, sizeof *noise);
    ck_assert(reference && noise);
    path_reference(&scene, 1 << (thorough() ? 22 : 20), reference, noise);
    double ranked = 0, unranked = 0;
    for (int n = 0; n < 3 + thorough(); n++) {
        char text[2048], setting[64];
        snprintf(text, sizeof text, as_it_comes, watts[n]);
        struct refiner *r = interpreted("unranked.dag", text, NULL);
        struct solve_options options = quick(2);
        struct solve s, t;
        const char *cause;
        ck_assert_ptr_nonnull(r);
        ck_assert_int_eq(solve_open(&s, &scene, &options, &cause), 0);
        ck_assert_int_eq(solve_run(&s, r, &cause), 0);
        refiner_close(r);
        snprintf(setting, sizeof setting, "links=%zu", s.refinement.link_count);
        char *const settings[] = {setting, (char *)"relative=0", NULL};
        solve_with(&t, &scene, "ranked", RELEASE_FLAT, settings, options);
        printf("ranked %.2f %% by %zu links, as it comes %.2f %% by %zu\n",
               100 * error_of(&t, reference), t.refinement.link_count,
               100 * error_of(&s, reference), s.refinement.link_count);
        ck_assert_uint_le(t.refinement.link_count, s.refinement.link_count + 3);
        ranked += error_of(&t, reference);
        unranked += error_of(&s, reference);
        solve_close(&s);
        solve_close(&t);
    }
    ck_assert_double_le(ranked, unranked);
    free(reference);
    free(noise);
    made_close(&scene);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("ranking");
    TCase *c = tcase_create("ranking");
    tcase_set_timeout(c, 600);
    tcase_add_loop_test(c, test_impact, 0, 2);
    tcase_add_test(c, test_worst_first);
    tcase_add_test(c, test_last);
    tcase_add_loop_test(c, test_alike, 0, 2);
    tcase_add_test(c, test_worth);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
