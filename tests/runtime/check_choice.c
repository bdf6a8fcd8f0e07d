/* check_choice.c - how many links there are: radScaleOracle, radSolveScene.
 *
 * Thresholds times a scale are compared with the same set one by one, and what is chosen with a
 * solution that is made so by hand. In an empty cube links pay; in a room of 196 boxes that hide
 * each other in part, on the floor and hung above it below a small lamp, particles alone take less.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "radiosity.h"
#include "suite.h"

enum { BOXES = 7, LAYERS = 4, MOST = 6 * (BOXES * BOXES * LAYERS + 2) };

struct room {
    double at[4 * MOST][3];
    uint32_t corner[MOST][4], material[MOST], corners, faces;
};

/* Six sides, seen from outside or, with inside, from there. */
static void put_box(struct room *r, const double p[3], const double size[3], int inside)
{
    static const uint32_t side[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                        {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (int i = 0; i < 6; i++, r->faces++)
        for (int j = 0; j < 4; j++)
            r->corner[r->faces][j] = r->corners + side[i][inside ? 3 - j : j];
    for (int i = 0; i < 8; i++, r->corners++)
        for (int k = 0; k < 3; k++)
            r->at[r->corners][k] = p[k] + (i >> k & 1 ? size[k] : 0);
}

static RadScene commit(RadDevice device, const struct room *r,
                       const struct RadMaterial materials[2])
{
    const struct RadPolygons polygons = {.positions = r->at[0],
                                         .position_count = r->corners,
                                         .indices = r->corner[0],
                                         .size = 4,
                                         .materials = r->material,
                                         .count = r->faces};
    RadScene scene = radNewScene(device);
    ck_assert_int_eq(radSetSceneMaterials(scene, materials, 2), 0);
    ck_assert_int_eq(radSetSceneSharedPolygons(scene, &polygons), 0);
    ck_assert_msg(radCommitScene(scene) == 0, "%s", radGetDeviceErrorMessage(device));
    return scene;
}

static RadScene open_scene(RadDevice device, int boxes)
{
    static struct room r;
    const double size[3] = {2.6 / BOXES, 2.6 / BOXES, 0.3};
    memset(&r, 0, sizeof r);
    put_box(&r, (double[3]){0, 0, 0}, (double[3]){6, 6, 3}, 1);
    for (int i = 0; boxes && i < BOXES * BOXES * LAYERS; i++)
        put_box(&r,
                (double[3]){0.3 + i % BOXES * 5.4 / BOXES, 0.3 + i / BOXES % BOXES * 5.4 / BOXES,
                            0.6 * (i / (BOXES * BOXES))},
                size, 0);
    put_box(&r, (double[3]){2.9, 2.9, 2.9}, (double[3]){0.2, 0.2, 0.05}, 0);
    for (uint32_t i = r.faces - 6; i < r.faces; i++)
        r.material[i] = 1;
    const struct RadMaterial materials[2] = {{{0.7, 0.7, 0.7}, {0, 0, 0}, 0},
                                             {{0, 0, 0}, {10, 10, 10}, 0}};
    return commit(device, &r, materials);
}

static RadOracle open_oracle(RadDevice device)
{
    return radNewOracle(device, radGetDefaultOracle(), RAD_RELEASE_FLAT);
}

struct asked {
    RadDevice device;
    RadScene scene;
    RadOracle oracle;
};

static struct asked ask(int boxes)
{
    RadDevice device = radNewDevice(NULL);
    return (struct asked){device, open_scene(device, boxes), open_oracle(device)};
}

static void release(const struct asked *a)
{
    radReleaseOracle(a->oracle);
    radReleaseScene(a->scene);
    radReleaseDevice(a->device);
}

static const struct RadSolveOptions linear = {.basis = RAD_BASIS_LINEAR};

static double radiosity_of(RadSolution solution, uint32_t polygons, double *all)
{
    double sum = 0;
    ck_assert_int_eq(radGetPolygonValues(solution, 0, all, NULL), 0);
    for (uint32_t i = 0; i < polygons; i++)
        sum += all[i];
    return sum;
}

/* ---- thresholds together */

static const char graph[] = "oracle a { param e : ratio = 0.5 in [0, 1] role link_threshold;"
                            " param s : ratio = 0.25 in [0, 1] role smallest_part;"
                            " param x : ratio = 0.125 in [0, 1];"
                            " fixed param z : ratio = 0.5 in [0, 9] role link_threshold; start t;"
                            " node t = transfer(relative = e * s * x * z) { otherwise -> stop; } }";

static void expect_parameters(RadOracle oracle, double e, double s, double x, double z)
{
    ck_assert_double_eq(radGetOracleParameter(oracle, "e"), e);
    ck_assert_double_eq(radGetOracleParameter(oracle, "s"), s);
    ck_assert_double_eq(radGetOracleParameter(oracle, "x"), x);
    ck_assert_double_eq(radGetOracleParameter(oracle, "z"), z);
}

START_TEST(test_scale)
{
    RadDevice device = radNewDevice(NULL);
    RadOracle oracle = radParseOracle(device, "mine", graph, NULL, RAD_RELEASE_DAG);
    ck_assert_msg(oracle != NULL, "%s", radGetDeviceErrorMessage(device));
    /* What is set counts, not the last scale; the smallest part never grows; ranges hold. */
    ck_assert_int_eq(radScaleOracle(oracle, 0.25), 2);
    expect_parameters(oracle, 0.125, 0.0625, 0.125, 0.5);
    ck_assert_int_eq(radScaleOracle(oracle, 0.5), 2);
    expect_parameters(oracle, 0.25, 0.125, 0.125, 0.5);
    ck_assert_int_eq(radScaleOracle(oracle, 16), 2);
    expect_parameters(oracle, 1, 0.25, 0.125, 0.5);
    ck_assert_int_eq(radScaleOracle(oracle, 1), 2);
    expect_parameters(oracle, 0.5, 0.25, 0.125, 0.5);
    /* What is set afterwards is what later scales are of. */
    ck_assert_int_eq(radSetOracleParameter(oracle, "e", 0.0625), 0);
    expect_parameters(oracle, 0.0625, 0.25, 0.125, 0.5);
    ck_assert_int_eq(radScaleOracle(oracle, 4), 2);
    expect_parameters(oracle, 0.25, 0.25, 0.125, 0.5);
    ck_assert_int_eq(radScaleOracle(NULL, 1), -1);
    ck_assert_int_eq(radGetDeviceError(device), RAD_ERROR_NONE);
    const double wrong[3] = {0, (double)INFINITY, (double)NAN};
    for (int i = 0; i < 3; i++) {
        ck_assert_int_eq(radScaleOracle(oracle, wrong[i]), -1);
        ck_assert_int_eq(radGetDeviceError(device), RAD_ERROR_INVALID_ARGUMENT);
    }
    expect_parameters(oracle, 0.25, 0.25, 0.125, 0.5);
    radReleaseOracle(oracle);
    radReleaseDevice(device);
}
END_TEST

/* ---- as many links as pay */

struct told {
    int times, none, stop;
    double first;
    RadSolution tried; /* the first, retained */
};

static int begin(void *user, RadSolution solution, const struct RadChoice *choice)
{
    struct told *told = user;
    struct RadReport report;
    radGetReport(solution, &report);
    ck_assert_int_eq(report.passes, 0);
    if (told->times++ == 0) {
        told->first = choice->scale;
        told->tried = solution;
        radRetainSolution(solution);
    }
    told->none += choice->no_links;
    return told->stop;
}

/* What the first try had others have by now. */
static void expect_empty(const struct asked *a, struct told *told)
{
    struct RadReport report;
    struct RadElements elements;
    radGetReport(told->tried, &report);
    ck_assert_uint_eq(report.elements, 0);
    radGetElements(told->tried, &elements);
    ck_assert_uint_eq(elements.count, 0);
    ck_assert_ptr_null(radGetHost(told->tried));
    ck_assert_int_eq(radSolve(told->tried), -1);
    ck_assert_int_eq(radGetDeviceError(a->device), RAD_ERROR_INVALID_OPERATION);
    radReleaseSolution(told->tried);
    told->times = 0;
}

/* What is chosen is what comes of the same scale, or of no links, by hand. */
static void expect_by_hand(RadDevice device, RadScene scene, RadSolution chosen,
                           const struct RadChoice *choice)
{
    struct RadSceneReport scene_report;
    radGetSceneReport(scene, &scene_report);
    double *a = calloc(2 * scene_report.polygons, sizeof *a), *b = a + scene_report.polygons;
    struct RadSolveOptions options = linear;
    options.no_links = choice->no_links;
    RadOracle oracle = open_oracle(device);
    ck_assert_int_gt(radScaleOracle(oracle, choice->scale), 0);
    RadSolution by_hand = radNewSolution(scene, oracle, &options);
    ck_assert_int_eq(radSolve(by_hand), 0);
    struct RadReport reports[2];
    radGetReport(chosen, &reports[0]);
    radGetReport(by_hand, &reports[1]);
    ck_assert_uint_eq(reports[0].rays, reports[1].rays);
    ck_assert_uint_eq(reports[0].elements, reports[1].elements);
    ck_assert_uint_eq(reports[0].link_fingerprint, reports[1].link_fingerprint);
    ck_assert_double_gt(radiosity_of(chosen, scene_report.polygons, a), 0);
    radiosity_of(by_hand, scene_report.polygons, b);
    ck_assert(memcmp(a, b, scene_report.polygons * sizeof *a) == 0);
    if (choice->no_links) { /* particles see what stands on what as ever */
        const struct RadCorrectOptions few = {.rays = 100000};
        ck_assert_int_eq(radCorrect(chosen, &few, NULL), 0);
        ck_assert_int_eq(radCorrect(by_hand, &few, NULL), 0);
        radiosity_of(chosen, scene_report.polygons, a);
        radiosity_of(by_hand, scene_report.polygons, b);
        ck_assert(memcmp(a, b, scene_report.polygons * sizeof *a) == 0);
    }
    free(a);
    radReleaseSolution(by_hand);
    radReleaseOracle(oracle);
}

START_TEST(test_links_pay)
{
    const struct asked a = ask(0);
    struct told told = {0};
    const struct RadChoiceOptions wishes = {.begin = begin, .user = &told};
    struct RadChoice choice;
    for (int i = 0; i < 2; i++) { /* the second finds thresholds that the first has scaled */
        RadSolution solution = radSolveScene(a.scene, a.oracle, &linear, &wishes, &choice);
        ck_assert_msg(solution != NULL, "%s", radGetDeviceErrorMessage(a.device));
        ck_assert_int_eq(choice.no_links, 0);
        ck_assert_double_eq(told.first, 16);
        ck_assert_uint_gt(choice.rays, 0);
        expect_by_hand(a.device, a.scene, solution, &choice);
        radReleaseSolution(solution);
        ck_assert_int_eq(told.times, 2);
        expect_empty(&a, &told);
    }
    release(&a);
}
END_TEST

START_TEST(test_links_do_not_pay)
{
    const struct asked a = ask(1);
    const double energy = radGetOracleParameter(a.oracle, "energy");
    struct told told = {0};
    struct RadChoiceOptions wishes = {.begin = begin, .user = &told};
    struct RadChoice choice;
    struct RadReport report;
    RadSolution solution = radSolveScene(a.scene, a.oracle, &linear, &wishes, &choice);
    ck_assert_msg(solution != NULL, "%s", radGetDeviceErrorMessage(a.device));
    /* The limit on pairs that the try at links met is no error. */
    ck_assert_int_eq(radGetDeviceError(a.device), RAD_ERROR_NONE);
    ck_assert_int_eq(choice.no_links, 1);
    ck_assert_int_eq(told.none, 2); /* to be measured, and as links cost too much */
    ck_assert_int_ge(told.times, 2);
    ck_assert_double_eq(radGetOracleParameter(a.oracle, "energy"), energy);
    radGetReport(solution, &report);
    ck_assert_uint_eq(report.links, 0);
    expect_by_hand(a.device, a.scene, solution, &choice);
    radReleaseSolution(solution);
    expect_empty(&a, &told);
    wishes.begin = NULL;
    /* Whoever wants links gets them, and who says how to solve for them. */
    wishes.keep_links = 1;
    solution = radSolveScene(a.scene, a.oracle, &linear, &wishes, &choice);
    radGetReport(solution, &report);
    ck_assert_int_eq(choice.no_links, 0);
    ck_assert_uint_gt(report.links, 0);
    radReleaseSolution(solution);
    const struct RadSolveOptions rows = {.basis = RAD_BASIS_LINEAR, .closure = RAD_CLOSURE_ROWS};
    solution = radSolveScene(a.scene, a.oracle, &rows, NULL, &choice);
    ck_assert_int_eq(choice.no_links, 0);
    radReleaseSolution(solution);
    /* A limit of one's own is met as ever. */
    const struct RadSolveOptions limited = {.basis = RAD_BASIS_LINEAR, .limits = {.pairs = 1000}};
    ck_assert_ptr_null(radSolveScene(a.scene, a.oracle, &limited, NULL, &choice));
    ck_assert_int_eq(radGetDeviceError(a.device), RAD_ERROR_LIMIT);
    release(&a);
}
END_TEST

/* A cube of 6 TILES^2 squares of one reflectance, which sees itself: no links take a ray. */
static RadScene open_tiles(RadDevice device, double reflectance)
{
    enum { TILES = 10 };
    static struct room r;
    memset(&r, 0, sizeof r);
    for (; r.faces < 6 * TILES * TILES; r.faces++) {
        const uint32_t i = r.faces, side = i / (TILES * TILES), axis = side / 2, far = side % 2;
        r.material[i] = i == 0;
        for (uint32_t j = 0; j < 4; j++, r.corners++) {
            const uint32_t right = (j == 1 || j == 2), up = j > 1;
            r.corner[i][far ? 3 - j : j] = r.corners;
            r.at[r.corners][axis] = far;
            r.at[r.corners][(axis + 1) % 3] = (double)(i % TILES + right) / TILES;
            r.at[r.corners][(axis + 2) % 3] = (double)(i / TILES % TILES + up) / TILES;
        }
    }
    const double rho = reflectance;
    const struct RadMaterial materials[2] = {{{rho, rho, rho}, {0, 0, 0}, 0},
                                             {{rho, rho, rho}, {10, 10, 10}, 0}};
    return commit(device, &r, materials);
}

/* Finer links in a white room would be swept over as often as coarse ones, and that is what they
 * cost, though they take no rays. */
START_TEST(test_sweeps_cost)
{
    const double reflectances[2] = {0.3, 0.98};
    for (int i = 0; i < 2; i++) {
        RadDevice device = radNewDevice(NULL);
        const struct asked a = {device, open_tiles(device, reflectances[i]), open_oracle(device)};
        struct RadChoice choice;
        RadSolution solution = radSolveScene(a.scene, a.oracle, &linear, NULL, &choice);
        ck_assert_msg(solution != NULL, "%s", radGetDeviceErrorMessage(device));
        ck_assert_int_eq(choice.no_links, 0);
        ck_assert_double_eq(choice.scale, i == 0 ? 1 : 16);
        radReleaseSolution(solution);
        release(&a);
    }
}
END_TEST

START_TEST(test_refused)
{
    const struct asked a = ask(0);
    struct told told = {.stop = 1};
    const struct RadChoiceOptions wishes = {.begin = begin, .user = &told};
    ck_assert_ptr_null(radSolveScene(a.scene, a.oracle, &linear, &wishes, NULL));
    ck_assert_int_eq(told.times, 1);
    ck_assert_int_eq(radGetDeviceError(a.device), RAD_ERROR_CANCELLED);
    expect_empty(&a, &told);
    const struct RadSolveOptions none = {.no_links = 1}, unit = {.unit = 1};
    ck_assert_ptr_null(radSolveScene(a.scene, a.oracle, &none, NULL, NULL));
    ck_assert_int_eq(radGetDeviceError(a.device), RAD_ERROR_INVALID_ARGUMENT);
    ck_assert_ptr_null(radSolveScene(a.scene, a.oracle, &unit, NULL, NULL));
    ck_assert_int_eq(radGetDeviceError(a.device), RAD_ERROR_INVALID_ARGUMENT);
    ck_assert_ptr_null(radSolveScene(a.scene, NULL, NULL, NULL, NULL));
    ck_assert_int_eq(radGetDeviceError(a.device), RAD_ERROR_INVALID_ARGUMENT);
    ck_assert_ptr_null(radSolveScene(NULL, a.oracle, NULL, NULL, NULL));
    release(&a);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("choice");
    TCase *t = tcase_create("choice");
    tcase_set_timeout(t, 120);
    tcase_add_test(t, test_scale);
    tcase_add_test(t, test_links_pay);
    tcase_add_test(t, test_links_do_not_pay);
    tcase_add_test(t, test_sweeps_cost);
    tcase_add_test(t, test_refused);
    suite_add_tcase(suite, t);
    return suite_failures(suite) != 0;
}
