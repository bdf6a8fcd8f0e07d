/* check_scale.c - the unit of length is nobody's business: all lengths times a power of two,
 * parameters with a unit of length too, and every oracle decides the same, links the same and
 * leaves the same radiosities, to the bit. Powers grow with the area.
 *
 * The built-in oracles use all tools but a few; `rest` asks those.
 * Once is enough: it is about numbers; that memory is used well, shorter suites tell.
 * SPDX-License-Identifier: MIT */
#include <stdio.h>
#include "oracle/builtin.h"
#include "runtime/make_solve.h"
#include "oracle/statistics.h"
#include "oracles.h"
#include "make_camera.h"
#include "suite.h"

static const int powers[] = {-20, 20};
enum { POWERS = sizeof powers / sizeof *powers };

static const char rest[] =
    "oracle rest \"what the others do not ask\" { param reach : length = 0.3 in [0, inf];\n"
    "  param small : area = 0.05 in [0, inf];\n"
    "  start level;\n"
    "  node level  = clusters() { surfaces -> boxes;  apart -> stop;  receiver | emitter -> lamps; "
    "}\n"
    "  node lamps  = dominates(share = 0.5) { none | emitter -> groups;  receiver | both -> "
    "groups; }\n"
    "  node groups = alpha_gap(relative = 0.5) { below | above -> open; }\n"
    "  node open   = opens(ratio = inf) { receiver -> subdivide_receiver;  emitter -> "
    "subdivide_emitter; }\n"
    "  node boxes  = overlap() { apart | overlapping -> lamp; }\n"
    "  node lamp   = dominates(share = 0.6) { none | receiver | emitter | both -> wide; }\n"
    "  node wide   = receiver_size(below = reach, share = 0) { small | big -> planes; }\n"
    "  node planes = coplanar() { yes -> stop;  no -> across; }\n"
    "  node across = straddle() { none | receiver | emitter | both -> close; }\n"
    "  node close  = near(within = 0.7) { touching | near | far -> edges; }\n"
    "  node edges  = edge_size(below = reach, share = 0) { coarse | fine -> turned; }\n"
    "  node turned = projected_area(below = small, share = 0) { small | large -> umbra; }\n"
    "  node umbra  = feature_size(min = reach) { small | big | too_complex -> point; }\n"
    "  node point  = point_form_factor() { done -> noted; }\n"
    "  node noted  = record(value = form_factor, slot = 1) { done -> slope; }\n"
    "  node slope  = gradient() { done -> varies; }\n"
    "  node varies = gradient_range(relative = 0.05) { otherwise -> some; }\n"
    "  node some   = sample_range() { done -> gaps; }\n"
    "  node gaps   = gap(relative = 0.1, weight = 1) { otherwise -> all; }\n"
    "  node all    = bound_range() { done -> within; }\n"
    "  node within = bounds(relative = 0.2) { otherwise -> fog; }\n"
    "  node fog    = extinction() { done -> dim; }\n"
    "  node dim    = record(value = visibility, slot = 2) { done -> sight; }\n"
    "  node sight  = exact_visibility() { none -> stop;  partial | all | too_complex -> seen; }\n"
    "  node seen   = record(value = visibility, slot = 3) { done -> energy; }\n"
    "  node energy = transfer(relative = 0.1) { dark -> stop;  below -> form;  above -> guard; }\n"
    "  node guard  = can_split(min_area = small) { both -> side;  neither -> form;\n"
    "                          receiver -> subdivide_receiver;  emitter -> subdivide_emitter; }\n"
    "  node side   = longer() { receiver -> subdivide_receiver;  emitter -> subdivide_emitter; }\n"
    "  node form   = exact_form_factor() { done -> link; }\n"
    "}\n";

/* How a quantity of this unit grows with the unit of length. */
static double grown(const char *unit, double length)
{
    return strcmp(unit, "m") == 0                              ? length
           : strcmp(unit, "m2") == 0 || strcmp(unit, "W") == 0 ? length * length
                                                               : 1;
}

/* Coarse enough for a test, every threshold with a unit at work. */
static void set(struct refiner *r, double length)
{
    for (int i = 0; i < r->parameter_count; i++) {
        const struct oracle_parameter *p = &r->parameters[i];
        double value = refiner_get(r, i);
        if (strcmp(p->name, "min_share") == 0)
            value = 4e-3;
        else if (strcmp(p->name, "from_faces") == 0)
            value = 1;
        else if (strcmp(p->name, "reference") == 0)
            value = 64;
        else if (strcmp(p->name, "links") == 0)
            value = 1e4;
        else if (p->unit[0] && !(value > 0))
            value = strcmp(p->unit, "m2") == 0 ? 0.02 : strcmp(p->unit, "W") == 0 ? 0.5 : 0.01;
        ck_assert_int_eq(refiner_set(r, p->name, value * grown(p->unit, length), NULL), 0);
    }
}

static void run(struct solve *s, struct scene *scene, struct refiner *r, struct camera *camera,
                double length)
{
    struct solve_options options = quick(2);
    furnished(scene, 1);
    for (int i = 0; i < 8; i++) { /* two groups far from each other */
        double high = i < 4 ? 0.3 : 2.7, along = 0.1 * (i % 4);
        made_quad(scene, 2, i < 4 ? 0.3 : 3.5, (i < 4 ? 0.3 : 4.3) + along, high, i < 4 ? 0.1 : 0,
                  i < 4 ? 0 : 0.08, 0, i < 4 ? 0 : 0.1, i < 4 ? 0.08 : 0, 0);
    }
    made_scale(scene, length);
    const double eye[3] = {3.9 * length, 4.9 * length, 2.9 * length}, at[3] = {0, 0, 0};
    *camera = made_camera(eye, at, 60, 1);
    options.camera = camera;
    options.closure = CLOSURE_ROWS;
    set(r, length);
    const char *cause;
    ck_assert_int_eq(solve_open(s, scene, &options, &cause), 0);
    ck_assert_int_eq(solve_run(s, r, &cause), 0);
    ck_assert_int_eq(s->report.converged, 1);
}

static void same_solution(const struct solve *a, const struct solve *b, double length)
{
    size_t values = (size_t)a->hierarchy.count * a->problem.bands;
    same_links(a, b);
    ck_assert_uint_eq(a->refinement.pairs, b->refinement.pairs);
    ck_assert(memcmp(a->refinement.decided, b->refinement.decided, sizeof a->refinement.decided)
              == 0);
    ck_assert(memcmp(a->refinement.marked, b->refinement.marked, sizeof a->refinement.marked) == 0);
    ck_assert(memcmp(a->state.radiosity, b->state.radiosity, values * sizeof(double)) == 0);
    ck_assert(memcmp(a->state.irradiance, b->state.irradiance, values * sizeof(double)) == 0);
    ck_assert_int_eq(a->report.passes, b->report.passes);
    ck_assert_int_eq(a->report.sweeps, b->report.sweeps);
    ck_assert_int_eq(a->problem.closed, b->problem.closed);
    ck_assert(a->report.rows.defect_mean == b->report.rows.defect_mean
              && a->report.residual == b->report.residual);
    ck_assert(a->report.emitted * length * length == b->report.emitted
              && a->report.absorbed * length * length == b->report.absorbed);
}

/* Every node gave each of its answers as often, and the same was recorded. */
static void same_answers(const struct RadStatistics *a, const struct RadStatistics *b)
{
    ck_assert_int_eq(a->node_count, b->node_count);
    for (int i = 0; i < a->node_count; i++)
        for (int k = 0; k < a->nodes[i].answer_count; k++)
            ck_assert_msg(a->nodes[i].answers[k].count == b->nodes[i].answers[k].count,
                          "%s answers %s, %llu times and %llu times", a->nodes[i].name,
                          a->nodes[i].answers[k].name,
                          (unsigned long long)a->nodes[i].answers[k].count,
                          (unsigned long long)b->nodes[i].answers[k].count);
    ck_assert(memcmp(a->counts, b->counts, RAD_COUNTS * sizeof *a->counts) == 0);
    ck_assert(memcmp(a->bins, b->bins, RAD_RECORDS * sizeof *a->bins) == 0);
    ck_assert(memcmp(a->zero, b->zero, RAD_RECORDS * sizeof *a->zero) == 0);
}

/* Every built-in oracle, then `rest`. */
START_TEST(test_oracle)
{
    const struct builtin *oracle = &builtins[_i];
    struct scene scene[POWERS + 1];
    struct solve s[POWERS + 1];
    struct statistics said[POWERS + 1];
    struct refiner *r[POWERS + 1]; /* whose names the statistics use */
    int answers = 0, last = thorough() ? POWERS : 1;
    for (int p = 0; p <= last; p++) {
        double length = p ? ldexp(1, powers[p - 1]) : 1;
        r[p] = interpreted("scale.dag", oracle->name ? oracle->text : rest, oracle->name);
        ck_assert_ptr_nonnull(r[p]);
        ck_assert_int_eq(refiner_count(r[p]), 0);
        struct camera camera;
        run(&s[p], &scene[p], r[p], &camera, length);
        ck_assert_int_eq(statistics_take(&said[p], r[p]), 0);
        if (p > 0) {
            same_answers(&said[0].shown, &said[p].shown);
            same_solution(&s[0], &s[p], length);
        }
    }
    for (int i = 0; i < said[0].shown.node_count; i++)
        for (int k = 0; k < said[0].shown.nodes[i].answer_count; k++)
            answers += said[0].shown.nodes[i].answers[k].count > 0;
    printf("%-15s %zu links, %llu discussions, %d answers of %d nodes, %d passes\n",
           oracle->name ? oracle->name : "rest", s[0].refinement.link_count,
           (unsigned long long)s[0].refinement.pairs, answers, said[0].shown.node_count,
           s[0].report.passes);
    ck_assert_uint_gt(s[0].refinement.link_count, 100);
    if (oracle->name && strncmp(oracle->name, "clusters", 8) == 0) /* clusters_feature, too */
        ck_assert_uint_gt(s[0].refinement.decided[DECISION_LINK_CLUSTERS], 0);
    for (int p = 0; p <= last; p++) {
        statistics_free(&said[p]);
        refiner_close(r[p]);
        solve_close(&s[p]);
        made_close(&scene[p]);
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("scale");
    TCase *c = tcase_create("scale");
    int oracles = 0;
    while (builtins[oracles].name)
        oracles++;
    tcase_set_timeout(c, 60);
    tcase_add_loop_test(c, test_oracle, 0, oracles + 1);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
