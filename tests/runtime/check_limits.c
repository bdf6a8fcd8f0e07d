/* check_limits.c - oracles that do not end, and arguments that are no numbers: refinement ends with
 * an error that says which limit or argument it was, what was reached, and the node at fault; the
 * same by all releases and any number of threads, soon, and in little memory.
 * Once is enough: it is about numbers; that memory is used well, shorter suites tell.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include "radiosity.h"
#include "suite.h"

/* The unit cube seen from inside, all of it a lamp of rho = 0.5. */
static const double corners[24] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0,
                                   0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1};
static const uint32_t sides[24] = {4, 7, 6, 5, 0, 1, 2, 3, 0, 4, 5, 1,
                                   1, 5, 6, 2, 2, 6, 7, 3, 3, 7, 4, 0};
static const uint32_t materials[6] = {0};

static RadScene cube(RadDevice device)
{
    const struct RadMaterial grey = {{0.5, 0.5, 0.5}, {1, 1, 1}, 0};
    const struct RadPolygons polygons = {.positions = corners,
                                         .position_count = 8,
                                         .indices = sides,
                                         .size = 4,
                                         .materials = materials,
                                         .count = 6};
    RadScene scene = radNewScene(device);
    ck_assert_ptr_nonnull(scene);
    ck_assert_int_eq(radSetSceneMaterials(scene, &grey, 1), 0);
    ck_assert_int_eq(radSetSceneSharedPolygons(scene, &polygons), 0);
    ck_assert_int_eq(radCommitScene(scene), 0);
    return scene;
}

/* Solves, takes the oracle over, and gives the message; it must end with that error (NONE: none).
 */
static const char *solve(RadDevice device, RadOracle oracle, struct RadLimits limits,
                         enum RadError error)
{
    static char message[2048];
    const struct RadSolveOptions options = {.limits = limits};
    ck_assert_msg(oracle != NULL, "%s", radGetDeviceErrorMessage(device));
    RadScene scene = cube(device);
    RadSolution solution = radNewSolution(scene, oracle, &options);
    ck_assert_msg(solution != NULL, "%s", radGetDeviceErrorMessage(device));
    int status = radSolve(solution);
    ck_assert_int_eq(status, error == RAD_ERROR_NONE ? 0 : -1);
    snprintf(message, sizeof message, "%s", radGetDeviceErrorMessage(device));
    ck_assert_int_eq(radGetDeviceError(device), error);
    if (error != RAD_ERROR_NONE) {
        ck_assert_int_eq(radSolve(solution), -1); /* it can only be released */
        (void)radGetDeviceError(device);
    }
    radReleaseSolution(solution);
    radReleaseScene(scene);
    radReleaseOracle(oracle);
    return message;
}

static void says(const char *message, const char *what)
{
    ck_assert_msg(strstr(message, what) != NULL, "no '%s' in: %s", what, message);
}

static void nothing(void *parameters)
{
    (void)parameters;
}

/* What dagc refuses to make and somebody's C may well be. */
static enum decision always(const void *parameters, struct discussion *d)
{
    (void)parameters;
    return d->receiver->vertices                         ? DECISION_SUBDIVIDE_RECEIVER
           : d->emitter->vertices || d->receiver->id & 1 ? DECISION_SUBDIVIDE_RECEIVER
                                                         : DECISION_SUBDIVIDE_EMITTER;
}

static enum decision larger_always(const void *parameters, struct discussion *d)
{
    (void)parameters;
    return !d->receiver->vertices                  ? DECISION_SUBDIVIDE_RECEIVER
           : !d->emitter->vertices                 ? DECISION_SUBDIVIDE_EMITTER
           : d->receiver->area >= d->emitter->area ? DECISION_SUBDIVIDE_RECEIVER
                                                   : DECISION_SUBDIVIDE_EMITTER;
}

static RadOracle by_hand(RadDevice device,
                         enum decision (*refine)(const void *, struct discussion *))
{
    const struct oracle oracle = {.abi = RUNTIME_ABI,
                                  .name = "runaway",
                                  .doc = "",
                                  .fingerprint = "",
                                  .parameters_size = 1,
                                  .defaults = nothing,
                                  .refine = refine};
    static struct oracle kept;
    kept = oracle;
    return radNewOracleCompiled(device, &kept, "hand");
}

/* ---- limits */

START_TEST(test_runaway)
{
    RadDevice device = radNewDevice(NULL);
    const char *message = solve(device, by_hand(device, _i ? larger_always : always),
                                (struct RadLimits){0}, RAD_ERROR_LIMIT);
    struct rusage used;
    says(message, _i ? "within depth=16" : "within elements=");
    says(message, "oracle runaway has made");
    says(message, ", and 0 links");
    ck_assert_ptr_null(strstr(message, "node")); /* nobody knows one */
    ck_assert_int_eq(getrusage(RUSAGE_SELF, &used), 0);
#ifndef __SANITIZE_ADDRESS__ /* which keeps what was freed, and shadows all memory */
    ck_assert_int_lt(used.ru_maxrss, 1000000); /* KB */
#endif
    radReleaseDevice(device);
}
END_TEST

/* Guards whose limits are set to 0: the node is named, by the flat release, too, and for any number
 * of threads it is the same text. */
START_TEST(test_zero_guards)
{
    char first[2048] = "";
    for (int i = 0; i < 4; i++) {
        RadDevice device = radNewDevice(&(struct RadDeviceOptions){.threads = 1 + i % 2});
        RadOracle oracle = radNewOracle(device, "bf", i < 2 ? RAD_RELEASE_FLAT : RAD_RELEASE_DAG);
        ck_assert_int_eq(radSetOracleParameter(oracle, "relative", 0), 0);
        ck_assert_int_eq(radSetOracleParameter(oracle, "min_share", 0), 0);
        const char *message =
            solve(device, oracle, (struct RadLimits){.depth = 6}, RAD_ERROR_LIMIT);
        says(message, "within depth=6: oracle bf");
        says(message, "7 splits deep");
        says(message, "node 'split__side' decides");
        says(message, "of larger -> subdivide_");
        if (i == 0)
            snprintf(first, sizeof first, "%s", message);
        ck_assert_str_eq(message, first);
        radReleaseDevice(device);
    }
}
END_TEST

/* Along the edges where faces meet, parts double with each split and all of them end in links: it
 * is depth that tells that this goes nowhere, and it must do so soon. */
START_TEST(test_edges)
{
    RadDevice device = radNewDevice(NULL);
    RadOracle oracle = radNewOracle(device, "bf_guarded", RAD_RELEASE_FLAT);
    unsigned long long pairs;
    ck_assert_int_eq(radSetOracleParameter(oracle, "min_share", 0), 0);
    const char *message = solve(device, oracle, (struct RadLimits){0}, RAD_ERROR_LIMIT);
    says(message, "within depth=16: oracle bf_guarded");
    says(message, "node 'faces__split__side' decides");
    const char *discussed = strstr(message, "has discussed ");
    ck_assert_int_eq(sscanf(discussed, "has discussed %llu pairs", &pairs), 1);
    ck_assert_uint_lt(pairs, 4000000); /* 2.65 M; with one split more, twice as many */
    radReleaseDevice(device);
}
END_TEST

/* Each limit by itself, of an oracle that ends: one less than what it needs is too little. */
START_TEST(test_each)
{
    static const char *const names[] = {"depth", "elements", "links", "pairs", "rounds"};
    RadDevice device = radNewDevice(NULL);
    RadOracle oracle = radNewOracle(device, "bf", RAD_RELEASE_FLAT);
    RadScene scene = cube(device);
    RadSolution solution = radNewSolution(scene, oracle, NULL);
    struct RadReport r;
    struct RadElements e;
    ck_assert_int_eq(radSolve(solution), 0);
    radGetReport(solution, &r);
    radGetElements(solution, &e);
    int depth = 0;
    for (uint32_t i = 0; i < e.count; i++)
        depth = e.elements[i].depth > depth ? e.elements[i].depth : depth;
    const uint64_t needs[] = {(uint64_t)depth, e.count - e.built, r.links, r.pairs, r.rounds};
    radReleaseSolution(solution);
    radReleaseScene(scene);
    for (int less = 0; less < 2; less++) {
        const uint64_t n = needs[_i] - (uint64_t)less;
        const struct RadLimits limits = {.depth = _i == 0 ? (int)n : 0,
                                         .elements = _i == 1 ? n : 0,
                                         .links = _i == 2 ? n : 0,
                                         .pairs = _i == 3 ? n : 0,
                                         .rounds = _i == 4 ? n : 0};
        radRetainOracle(oracle);
        const char *message =
            solve(device, oracle, limits, less ? RAD_ERROR_LIMIT : RAD_ERROR_NONE);
        char within[64];
        snprintf(within, sizeof within, "within %s=%llu:", names[_i], (unsigned long long)n);
        if (less)
            says(message, within);
    }
    radReleaseOracle(oracle);
    radReleaseDevice(device);
}
END_TEST

/* ---- numbers */

static const char quotient[] =
    "oracle quotient { param p : ratio = 0.1 in [0, inf]; param q : ratio = 1 in [0, inf];\n"
    "  start level;\n"
    "  node level = clusters() { surfaces -> a;  apart -> stop;\n"
    "                            receiver -> subdivide_receiver;  emitter -> subdivide_emitter; }\n"
    "  node a = transfer(relative = max(0, p / q)) { dark -> stop;  below | above -> b; }\n"
    "  node b = transfer(relative = max(p * q, 0)) { dark -> stop;  below | above -> c; }\n"
    "  node c = transfer(relative = min(1 / max(0, -1 * (p - q)), 7)) { dark -> stop;  below | "
    "above -> "
    "form; }\n"
    "  node form = form_factor() { done -> see; }\n"
    "  node see = visibility() { none -> stop;  partial | all -> link; } }\n";

/* 0 / 0 and 0 * inf come through max either way round, and are told of by both releases alike; -0
 * does not: 1 / max(0, -0) is inf. */
START_TEST(test_no_number)
{
    static const struct {
        double p, q;
        const char *says;
    } cases[] = {
        {0.1, 1, NULL},
        {0, 0, "'relative' of node 'a' is no number from 0 to inf: max(0, p / q)"},
        {(double)INFINITY, (double)INFINITY, "node 'a' is no number"},
        {0, (double)INFINITY, "'relative' of node 'b' is no number from 0 to inf: max(p * q, 0)"},
        {0, 1, NULL},
        {1, 1, NULL}};
    RadDevice device = radNewDevice(NULL);
    RadOracle oracle = radParseOracle(device, "quotient.dag", quotient, NULL,
                                      _i ? RAD_RELEASE_DAG : RAD_RELEASE_FLAT);
    ck_assert_msg(oracle != NULL, "%s", radGetDeviceErrorMessage(device));
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        ck_assert_int_eq(radSetOracleParameter(oracle, "p", cases[i].p), 0);
        ck_assert_int_eq(radSetOracleParameter(oracle, "q", cases[i].q), 0);
        radRetainOracle(oracle);
        const char *message = solve(device, oracle, (struct RadLimits){0},
                                    cases[i].says ? RAD_ERROR_INVALID_ORACLE : RAD_ERROR_NONE);
        if (cases[i].says)
            says(message, cases[i].says);
    }
    radReleaseOracle(oracle);
    radReleaseDevice(device);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("limits");
    TCase *c = tcase_create("limits");
    tcase_set_timeout(c, 300);
    tcase_add_loop_test(c, test_runaway, 0, 2);
    tcase_add_test(c, test_zero_guards);
    tcase_add_test(c, test_edges);
    tcase_add_loop_test(c, test_each, 0, 5);
    tcase_add_loop_test(c, test_no_number, 0, 2);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
