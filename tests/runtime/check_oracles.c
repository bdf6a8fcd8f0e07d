/* check_oracles.c - every oracle of examples/oracles: its error falls with its threshold, and
 * thermal keeps its promise. That releases decide alike, at every node: check_releases.c.
 *
 * References: closed forms where there are some, else path tracing (path_reference.h).
 * Once is enough: it is about numbers; that memory is used well, shorter suites tell.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "oracle/builtin.h"
#include "scene/make_scene.h"
#include "scene/read_scene.h"
#include "util/oracles.h"
#include "runtime/path_reference.h"
#include "engine/solve.h"
#include "command.h"
#include "suite.h"

/* Outside a test, too. */
static void must(int done, const char *what)
{
    if (!done) {
        fprintf(stderr, "%s failed\n", what);
        abort();
    }
}

/* Solve with an oracle; settings end with NULL. */
static void solve_with(struct solve *s, const struct scene *scene, const char *oracle,
                       char *const *settings)
{
    struct solve_options options = {.tolerance = 1e-5, .iterations = 100000, .threads = 2};
    struct refiner *r = oracles_open(oracle, RELEASE_FLAT);
    int n = 0;
    while (settings && settings[n])
        n++;
    must(r && oracles_set(r, settings, n) == 0, oracle);
    const char *cause;
    must(solve_open(s, scene, &options, &cause) == 0, "solve_open");
    must(solve_run(s, r, &cause) == 0, "solve_run");
    refiner_close(r);
}

/* Sum over the faces of |rho A (H - H_ref)| in one band (W), and the same of all that they
 * reflect. */
static double power_error(const struct solve *s, const double *reference, uint32_t band,
                          double *all)
{
    double sum = 0;
    *all = 0;
    for (uint32_t i = 0; i < s->problem.scene->face_count; i++) {
        size_t at = (size_t)i * s->problem.bands + band, element = s->hierarchy.face_element[i];
        double power = s->problem.reflectance[at] * s->hierarchy.elements[element].area;
        sum += power * fabs(s->state.irradiance[element * s->problem.bands + band] - reference[at]);
        *all += power * reference[at];
    }
    return sum;
}

/* ---- releases */

/* The default is what programs run: its releases decide alike, by hand too, where groups are
 * linked, where shafts and outlines come after rays, where emitters are uneven, and where nothing
 * may be split. */
static const char *const ways[] = {
    "cornell.obj --set min_share=1e-3",
    "room.obj --set noise=1e-6 --set hidden=0.5 --set min_share=1e-2",
    "room.obj --set product=1 --set shadow=1e-3 --set larger=1 --set min_share=1e-2",
    "cornell.obj --set spot=0 --set uneven=40 --set bend=1e-3 --set noise=1e-5",
    /* as they come */
    "cornell.obj",
    "room.obj",
    "maze_8.obj",
    "td.obj",
};

START_TEST(test_default_by_hand)
{
    ck_assert(oracles_by_hand(DEFAULT_ORACLE));
    ck_assert_msg(shell("$RADIOSITY compare examples/scenes/%s --oracle %s --repeats 1 > /dev/null",
                        ways[_i], DEFAULT_ORACLE)
                      == 0,
                  "%s", ways[_i]);
}
END_TEST

/* What compiled oracles say of themselves is what their graphs say: facts that are read, roles
 * of parameters. */
START_TEST(test_declared)
{
    int reading = 0, roles = 0;
    for (const struct builtin *b = builtins; b->name; b++) {
        struct refiner *flat = oracles_open(b->name, RELEASE_FLAT),
                       *dag = oracles_open(b->name, RELEASE_DAG);
        ck_assert(flat && dag);
        ck_assert_int_eq(flat->read_count, dag->read_count);
        for (int i = 0; i < flat->read_count; i++)
            ck_assert_int_eq(flat->reads[i], dag->reads[i]);
        ck_assert_int_eq(flat->parameter_count, dag->parameter_count);
        for (int i = 0; i < flat->parameter_count; i++) {
            ck_assert_int_eq(flat->parameters[i].role, dag->parameters[i].role);
            roles += flat->parameters[i].role != ROLE_NONE;
        }
        reading += flat->read_count > 0;
        ck_assert_int_eq(refiner_reads(flat, FACT_RECEIVER_IMPORTANCE),
                         strcmp(b->name, "importance") == 0);
        ck_assert_int_eq(refiner_reads(flat, FACT_SCENE_RANK), strcmp(b->name, "ranked") == 0);
        ck_assert_int_eq(refiner_reads(flat, FACT_EMITTER_LOWER), strcmp(b->name, "bracket") == 0);
        ck_assert_int_eq(refiner_reads(flat, FACT_RECEIVER_TOLERANCE),
                         strcmp(b->name, "error_control") == 0);
        ck_assert_int_eq(refiner_find_role(flat, ROLE_ERROR_TOLERANCE, -1) >= 0,
                         strcmp(b->name, "error_control") == 0);
        ck_assert_int_eq(refiner_find_role(flat, ROLE_SHADOW_TOLERANCE, -1) >= 0,
                         strcmp(b->name, "viewfactors") == 0);
        refiner_close(flat);
        refiner_close(dag);
    }
    ck_assert_int_ge(reading, 2);
    ck_assert_int_ge(roles, 20); /* thresholds and smallest parts besides */
}
END_TEST

/* ---- convergence */

/* An oracle, its threshold, how fine it gets, and the error that is left then. */
static const struct falling {
    const char *oracle;
    const char *coarse[2], *fine[2], *finest[2];
    double left[3]; /* cube, parallel plates, perpendicular plates */
} falling[] = {
    {"ff", {"limit=0.3"}, {"limit=0.1"}, {"limit=0.02"}, {1.5e-3, 2e-4, 1.2e-3}},
    {"bf", {"relative=0.5"}, {"relative=0.1"}, {"relative=0.02"}, {3e-3, 2e-4, 1.2e-3}},
    {"bf_guarded", {"relative=0.5"}, {"relative=0.1"}, {"relative=0.02"}, {3e-3, 2e-4, 1.2e-3}},
    {"clusters", {"relative=0.5"}, {"relative=0.1"}, {"relative=0.02"}, {3e-3, 2e-4, 1.2e-3}},
    {"power",
     {"bend=5e-4", "shadow=1e-3"},
     {"bend=1e-4", "shadow=1e-4"},
     {"bend=1e-5", "shadow=1e-5"},
     {2.5e-3, 2e-4, 1.2e-3}},
    {"bfv", {"relative=0.5"}, {"relative=0.1"}, {"relative=0.02"}, {3e-3, 2e-4, 1.2e-3}},
    {"relative", {"exitance=0.1"}, {"exitance=0.02"}, {"exitance=0.004"}, {2.5e-3, 2e-4, 6e-4}},
    {"gap", {"relative=0.5"}, {"relative=0.1"}, {"relative=0.02"}, {1e-3, 2e-4, 3e-4}},
    {"error_control", {"relative=1"}, {"relative=0.3"}, {"relative=0.1"}, {2e-3, 2e-4, 5e-3}},
    {"smooth", {"relative=0.5"}, {"relative=0.1"}, {"relative=0.02"}, {1.5e-3, 2e-4, 1e-3}},
    {"importance", {"relative=0.25"}, {"relative=0.05"}, {"relative=0.01"}, {1e-3, 2e-4, 3e-4}},
    {"feature",
     {"relative=0.5", "energy=0.5"},
     {"relative=0.1", "energy=0.1"},
     {"relative=0.02", "energy=0.02"},
     {1e-3, 2e-4, 3e-4}},
    {"clusters_feature",
     {"relative=0.5", "energy=0.5"},
     {"relative=0.1", "energy=0.1"},
     {"relative=0.02", "energy=0.02"},
     {1e-3, 2e-4, 3e-4}},
    {"gibson_hubbold", {"relative=0.5"}, {"relative=0.1"}, {"relative=0.02"}, {1.5e-3, 2e-4, 5e-4}},
    {"thermal", {"share=3"}, {"share=0.3"}, {"share=0.03"}, {4e-3, 2e-4, 5e-3}},
    {"shadows",
     {"relative=0.5", "visible=0.5"},
     {"relative=0.1", "visible=0.1"},
     {"relative=0.02", "visible=0.02"},
     {1e-3, 2e-4, 3e-4}},
    {"bracket", {"relative=1e-2"}, {"relative=1e-3"}, {"relative=1e-5"}, {2e-3, 2e-4, 1e-3}},
    {"ranked", {"relative=1e-3"}, {"relative=1e-4"}, {"relative=3e-6"}, {1e-3, 2e-4, 1e-3}},
    {"masking", {"relative=0.5"}, {"relative=0.1"}, {"relative=0.02"}, {3e-3, 2e-4, 1.2e-3}},
    {"kok", {"relative=0.5"}, {"relative=0.1"}, {"relative=0.02"}, {3e-3, 2e-4, 1.2e-3}},
    {"by_reliability", {"relative=0.5"}, {"relative=0.1"}, {"relative=0.02"}, {3e-3, 2e-4, 1.2e-3}},
    {"tester", {"relative=0.5"}, {"relative=0.1"}, {"relative=0.02"}, {3e-3, 2e-4, 1.2e-3}},
};

enum { FALLING = sizeof falling / sizeof *falling };

/* A cube with E = 1 on its ceiling, or two unit squares with E = 1: parallel at the distance 1,
 * or with a common edge. All rho = .5. */
static void make_known(struct scene *s, int which, double *known)
{
    made_open(s);
    uint32_t wall = made_material(s, 0.5, which ? 1 : 0);
    if (which == 0) {
        uint32_t lamp = made_material(s, 0.5, 1);
        uint32_t m[6];
        for (uint32_t f = 0; f < 6; f++) {
            m[f] = f == 1 ? lamp : wall;
            known[f] = f == 0 ? 0.1712161 : f == 1 ? 1.1043616 : 0.1811056;
        }
        made_room(s, m, 1, 1, 1);
        return;
    }
    known[0] = known[1] = which == 1 ? 1.111165244298 : 1.1159537;
    made_quad(s, wall, 0, 0, 0, 1, 0, 0, 0, 1, 0);
    if (which == 1)
        made_quad(s, wall, 0, 0, 1, 0, 1, 0, 1, 0, 0);
    else
        made_quad(s, wall, 0, 0, 0, 0, 0, 1, 1, 0, 0);
}

START_TEST(test_falling)
{
    const struct falling *f = &falling[_i / 3];
    const char *const *steps[3] = {f->coarse, f->fine, f->finest};
    double known[6], worst[3] = {0, 0, 0};
    size_t links[3] = {0, 0, 0};
    /* of the cube it takes a hundred thousand links, and gibson_hubbold many more discussions */
    int costly = strcmp(f->oracle, "gibson_hubbold") == 0 && _i % 3 != 1, i;
    int finest = thorough() || (_i % 3 > 0 && !costly);
    if (!thorough() && costly && _i % 3 == 0)
        return;
    for (i = 0; i < 2 + finest; i++) {
        char *settings[4] = {(char *)"min_share=1e-4", (char *)steps[i][0], (char *)steps[i][1],
                             NULL};
        struct scene scene;
        make_known(&scene, _i % 3, known);
        struct solve s;
        solve_with(&s, &scene, f->oracle, settings);
        worst[i] = 0;
        for (uint32_t k = 0; k < scene.face_count; k++)
            worst[i] =
                fmax(worst[i], fabs(s.state.radiosity[s.hierarchy.face_element[k]] - known[k]));
        links[i] = s.refinement.link_count;
        solve_close(&s);
        made_close(&scene);
    }
    printf("%-14s %s: error %.1e %.1e %.1e by %zu, %zu, %zu links\n", f->oracle,
           _i % 3 == 0   ? "cube"
           : _i % 3 == 1 ? "parallel"
                         : "perpendicular",
           worst[0], worst[1], worst[2], links[0], links[1], links[2]);
    ck_assert_uint_le(links[0], links[1]);
    /* Within what quadrature leaves, 1e-4, it never rises. */
    ck_assert_double_le(worst[1], worst[0] + 1e-4);
    if (finest) {
        ck_assert_uint_le(links[1], links[2]);
        ck_assert_double_le(worst[2], worst[1] + 1e-4);
        ck_assert_double_le(worst[2], f->left[_i % 3]);
    }
}
END_TEST

/* ---- thermal's promise */

/* Sum over the faces of what radiosity times area is wrong, in every band, within the tolerance,
 * against a reference whose standard errors come to no more than a quarter of that, together. Its
 * noise adds to what is found. */
START_TEST(test_promise)
{
    static const struct {
        const char *scene;
        double watts;
    } promise[] = {
        {"furnace", 0.3}, {"cornell", 0.05}, {"maze_8", 60}, {"room", 16}, {"furnace_4", 0.4},
    };
    char setting[64], path[128], *settings[3] = {setting, (char *)"share=0", NULL};
    struct scene_options how = {.quiet = 1};
    snprintf(setting, sizeof setting, "tolerance_watts=%g", promise[_i].watts);
    snprintf(path, sizeof path, "examples/scenes/%s.obj", promise[_i].scene);
    struct scene scene;
    ck_assert_int_eq(scene_read(&scene, path, &how), 0);
    double *reference;
    reference = calloc((size_t)scene.face_count * scene.bands, sizeof *reference);
    double *noise;
    noise = calloc((size_t)scene.face_count * scene.bands, sizeof *noise);
    path_reference(&scene, 1 << 18, reference, noise);
    struct solve s;
    solve_with(&s, &scene, "thermal", settings);
    double all;
    for (uint32_t k = 0; k < scene.bands; k++) {
        double wrong = power_error(&s, reference, k, &all), unsure = 0;
        for (uint32_t i = 0; i < scene.face_count; i++)
            unsure += s.problem.reflectance[(size_t)i * s.problem.bands + k]
                      * hierarchy_surface(&s.hierarchy, i)->area
                      * noise[(size_t)i * s.problem.bands + k];
        printf("thermal %s, band %u: %.3g W wrong (reference +- %.2g W), %g W promised, of %.4g W; "
               "%zu links, %llu whole by a guard\n",
               promise[_i].scene, k, wrong, unsure, promise[_i].watts, all, s.refinement.link_count,
               (unsigned long long)s.refinement.marked[1]);
        ck_assert_double_le(unsure, 0.25 * promise[_i].watts);
        ck_assert_double_le(wrong, promise[_i].watts);
    }
    ck_assert_uint_le(s.refinement.link_count, 1000000);
    solve_close(&s);
    free(reference);
    free(noise);
    scene_free(&scene);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("oracles");
    TCase *c = tcase_create("oracles");
    tcase_set_timeout(c, 600);
    tcase_add_loop_test(c, test_default_by_hand, 0, thorough() ? 8 : 4);
    tcase_add_test(c, test_declared);
    tcase_add_loop_test(c, test_falling, 0, 3 * FALLING);
    tcase_add_loop_test(c, test_promise, 0, thorough() ? 5 : 2);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
