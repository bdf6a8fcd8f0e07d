/* check_api.c - libradiosity as a program sees it: linked with the archive alone, by radiosity.h
 * alone.
 *
 * Furnaces have the exact solution B = E / (1 - rho); the cube's view factors are Howell's C-11 and
 * C-14.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "radiosity.h"
#include "suite.h"

/* The unit cube seen from inside: ceiling, floor, walls. */
static const double corners[24] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0,
                                   0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1};
static const uint32_t sides[24] = {4, 7, 6, 5, 0, 1, 2, 3, 0, 4, 5, 1,
                                   1, 5, 6, 2, 2, 6, 7, 3, 3, 7, 4, 0};
static const uint32_t lamp_above[6] = {0, 1, 1, 1, 1, 1};

static struct RadPolygons cube(const uint32_t *materials)
{
    return (struct RadPolygons){.positions = corners,
                                .position_count = 8,
                                .indices = sides,
                                .size = 4,
                                .materials = materials,
                                .count = 6};
}

static struct RadMaterial grey(double rho, double exitance)
{
    return (struct RadMaterial){{rho, rho, rho}, {exitance, exitance, exitance}, 0};
}

static RadScene make_scene(RadDevice device, const struct RadPolygons *polygons,
                           const struct RadMaterial *materials, uint32_t count)
{
    RadScene scene = radNewScene(device);
    ck_assert_ptr_nonnull(scene);
    ck_assert_int_eq(radSetSceneMaterials(scene, materials, count), 0);
    ck_assert_int_eq(radSetSceneSharedPolygons(scene, polygons), 0);
    ck_assert_msg(radCommitScene(scene) == 0, "%s", radGetDeviceErrorMessage(device));
    return scene;
}

/* The cube with a lamp for its ceiling. */
static RadScene lamp_scene(RadDevice device, double rho)
{
    const struct RadMaterial materials[2] = {grey(rho, 1), grey(rho, 0)};
    const struct RadPolygons p = cube(lamp_above);
    return make_scene(device, &p, materials, 2);
}

static RadOracle default_oracle(RadDevice device)
{
    RadOracle oracle = radNewOracle(device, radGetDefaultOracle(), RAD_RELEASE_FLAT);
    ck_assert_ptr_nonnull(oracle);
    return oracle;
}

/* The device's error is this one, its sentence holds `part`, and then it is forgotten. */
static void expect_error(RadDevice device, enum RadError code, const char *part)
{
    const char *said = radGetDeviceErrorMessage(device);
    ck_assert_msg(strstr(said, part) != NULL, "'%s' does not say '%s'", said, part);
    ck_assert_int_eq(radGetDeviceError(device), code);
    ck_assert_int_eq(radGetDeviceError(device), RAD_ERROR_NONE);
    ck_assert_str_eq(radGetDeviceErrorMessage(device), "");
}

/* ---- light */

START_TEST(test_furnace)
{
    const struct RadMaterial m = {{0.5, 0.2, 0.8}, {1, 2, 0.25}, 0};
    const struct RadPolygons p = cube(NULL);
    const struct RadSolveOptions closed = {.closure = RAD_CLOSURE_ROWS, .tolerance = 1e-6};
    RadDevice device = radNewDevice(NULL);
    RadScene scene = make_scene(device, &p, &m, 1);
    RadOracle oracle = default_oracle(device);
    RadSolution solution = radNewSolution(scene, oracle, &closed);
    struct RadSceneReport s;
    ck_assert_int_eq(radGetSceneReport(scene, &s), 0);
    ck_assert_uint_eq(s.bands, RAD_COLOUR);
    ck_assert_uint_eq(s.polygons, 6);
    ck_assert_uint_eq(s.faces, 6);
    ck_assert_double_eq_tol(s.area, 6, 1e-12);
    ck_assert_double_eq(s.high[2], 1);
    ck_assert_double_eq(radGetScenePolygonAreas(scene)[3], 1);
    ck_assert_int_eq(radSolve(solution), 0);
    struct RadReport r;
    radGetReport(solution, &r);
    ck_assert_int_eq(r.converged, 1);
    ck_assert_int_eq(r.closed, 1);
    ck_assert_uint_eq(r.bands, 3);
    for (uint32_t k = 0; k < 3; k++) {
        double b[6], h[6], exact = m.exitance[k] / (1 - m.reflectance[k]);
        ck_assert_int_eq(radGetPolygonValues(solution, k, b, h), 0);
        for (int i = 0; i < 6; i++) {
            ck_assert_double_eq_tol(b[i], exact, 5e-6 * exact);
            ck_assert_double_eq_tol(h[i], exact, 5e-6 * exact);
        }
    }
    ck_assert_double_eq_tol(r.absorbed, r.emitted, 1e-5 * r.emitted);
    ck_assert_int_eq(radGetDeviceError(device), RAD_ERROR_NONE);
    radReleaseSolution(solution);
    radReleaseOracle(oracle);
    radReleaseScene(scene);
    radReleaseDevice(device);
}
END_TEST

/* Steps are the solve. */
START_TEST(test_steps)
{
    RadDevice device = radNewDevice(NULL);
    RadScene scene = lamp_scene(device, 0.5);
    RadOracle oracle = default_oracle(device);
    RadSolution at_once = radNewSolution(scene, oracle, NULL),
                by_steps = radNewSolution(scene, oracle, NULL);
    double a[6], b[6];
    ck_assert_int_eq(radSolve(at_once), 0);
    ck_assert_int_eq(radRefine(by_steps), 0);
    ck_assert_int_eq(radRefine(by_steps), -1);
    expect_error(device, RAD_ERROR_INVALID_OPERATION, "radRefine");
    int more;
    do {
        more = radStep(by_steps);
    } while (more == 1);
    ck_assert_int_eq(more, 0);
    ck_assert_int_eq(radGetPolygonValues(at_once, 0, a, NULL), 0);
    ck_assert_int_eq(radGetPolygonValues(by_steps, 0, b, NULL), 0);
    ck_assert_int_eq(memcmp(a, b, sizeof a), 0);
    radReleaseSolution(at_once);
    radReleaseSolution(by_steps);
    radReleaseOracle(oracle);
    radReleaseScene(scene);
    radReleaseDevice(device);
}
END_TEST

/* What a leaf receives, over its own links and those of what it is part of. */
static double row_of(const struct RadElements *x, const struct RadLinks *links, uint32_t e)
{
    double sum = 0;
    for (;; e = x->elements[e].parent) {
        for (size_t l = links->first[e]; l < links->first[e + 1]; l++)
            sum +=
                (double)links->links[l].form_factor * links->links[l].visibility / RAD_LINK_VISIBLE;
        if (x->elements[e].parent == e)
            return sum;
    }
}

START_TEST(test_views)
{
    RadDevice device = radNewDevice(NULL);
    RadScene scene = lamp_scene(device, 0.5);
    RadOracle oracle = default_oracle(device);
    RadSolution solution = radNewSolution(scene, oracle, NULL);
    struct RadLinks links;
    radGetLinks(solution, &links);
    ck_assert_uint_eq(links.count, 0);
    struct RadElements x;
    radGetElements(solution, &x);
    ck_assert_double_eq(x.radiosity[x.face_element[0]], 1);
    ck_assert_int_eq(radSolve(solution), 0);
    radGetElements(solution, &x);
    radGetLinks(solution, &links);
    struct RadReport r;
    radGetReport(solution, &r);
    ck_assert_uint_eq(x.count, r.elements);
    ck_assert_uint_eq(links.count, r.links);
    ck_assert_uint_eq(links.first[x.count], links.count);
    for (uint32_t e = 0; e < x.count; e++)
        for (size_t l = links.first[e]; l < links.first[e + 1]; l++) {
            ck_assert_uint_eq(links.links[l].receiver, e);
            ck_assert_uint_lt(links.links[l].emitter, x.count);
        }
    uint32_t leaves = 0;
    double low = 2, high = 0;
    for (uint32_t e = 0; e < x.count; e++) {
        if (x.elements[e].children)
            continue;
        double row = row_of(&x, &links, e);
        low = fmin(low, row);
        high = fmax(high, row);
        leaves++;
    }
    ck_assert_uint_eq(leaves, r.leaves);
    ck_assert_double_eq_tol(low, r.rows.low, 1e-6);
    ck_assert_double_eq_tol(high, r.rows.high, 1e-6);
    radReleaseSolution(solution);
    radReleaseOracle(oracle);
    radReleaseScene(scene);
    radReleaseDevice(device);
}
END_TEST

/* Gradients: none before the last step, none without the basis; then B at the corners of every
 * surface is not negative, and the mean over a face, of which its leaves' are parts, is the
 * polygon's. */
START_TEST(test_linear)
{
    RadDevice device = radNewDevice(NULL);
    RadScene scene = lamp_scene(device, 0.5);
    RadOracle oracle = default_oracle(device);
    const struct RadSolveOptions how = {.basis = RAD_BASIS_LINEAR};
    RadSolution plain = radNewSolution(scene, oracle, NULL),
                linear = radNewSolution(scene, oracle, &how);
    struct RadElements x;
    struct RadReport r;
    int more;
    while ((more = radStep(linear)) > 0) {
        radGetElements(linear, &x);
        ck_assert_ptr_null(x.gradient);
    }
    ck_assert_int_eq(more, 0);
    radGetReport(linear, &r);
    ck_assert_int_gt(r.linear.sweeps, 0);
    ck_assert_int_eq(r.converged, 1);
    radGetElements(linear, &x);
    ck_assert_ptr_nonnull(x.gradient);
    double steepest = 0;
    for (uint32_t e = 0; e < x.count; e++)
        for (uint32_t k = 0; k < x.bands; k++) {
            size_t at = (size_t)e * x.bands + k;
            const double *g = &x.gradient[3 * at];
            double square = dot3(g, g);
            steepest = fmax(steepest, square);
            if (!x.elements[e].vertices)
                ck_assert_double_eq(square, 0);
            ck_assert_double_le(fabs(dot3(g, x.elements[e].normal)), 1e-9 * sqrt(square));
            for (int i = 0; i < x.elements[e].vertices; i++) {
                double away[3];
                sub3(away, x.elements[e].vertex[i], x.elements[e].centre);
                ck_assert_double_ge(x.radiosity[at] + dot3(g, away), -1e-12);
            }
        }
    ck_assert_double_gt(steepest, 1e-4);
    struct RadSceneReport report;
    ck_assert_int_eq(radGetSceneReport(scene, &report), 0);
    double *mean = malloc(report.polygons * sizeof *mean);
    ck_assert_int_eq(radGetPolygonValues(linear, 0, mean, NULL), 0);
    ck_assert_double_eq_tol(mean[0], x.radiosity[x.face_element[0] * x.bands], 1e-12);
    free(mean);
    ck_assert_int_eq(radSolve(plain), 0);
    radGetElements(plain, &x);
    ck_assert_ptr_null(x.gradient);
    radGetReport(plain, &r);
    ck_assert_int_eq(r.linear.sweeps, 0);
    radReleaseSolution(plain);
    radReleaseSolution(linear);
    radReleaseOracle(oracle);
    radReleaseScene(scene);
    radReleaseDevice(device);
}
END_TEST

/* The same links with other form factors: with their own the same light, with none no more than is
 * emitted; and then nothing is left to do. */
START_TEST(test_factors)
{
    RadDevice device = radNewDevice(NULL);
    RadScene scene = lamp_scene(device, 0.5);
    RadOracle oracle = default_oracle(device);
    const struct RadSolveOptions exact = {.tolerance = 1e-12};
    RadSolution solution = radNewSolution(scene, oracle, &exact);
    float none = 0;
    ck_assert_int_eq(radSolveWithFactors(solution, &none), -1);
    expect_error(device, RAD_ERROR_INVALID_OPERATION, "no links yet");
    ck_assert_int_eq(radSolve(solution), 0);
    struct RadLinks links;
    struct RadElements x;
    double before[6], after[6];
    radGetLinks(solution, &links);
    ck_assert_int_eq(radGetPolygonValues(solution, 0, before, NULL), 0);
    const size_t count = links.count;
    float *factors = malloc(count * sizeof *factors);
    ck_assert_ptr_nonnull(factors);
    for (size_t i = 0; i < count; i++)
        factors[i] = links.links[i].form_factor;
    ck_assert_int_eq(radSolveWithFactors(solution, NULL), -1);
    expect_error(device, RAD_ERROR_INVALID_ARGUMENT, "a form factor for each link");
    const float bad[] = {-1, (float)NAN, (float)INFINITY};
    for (int i = 0; i < 3; i++) {
        const float good = factors[count / 2];
        factors[count / 2] = bad[i];
        ck_assert_int_eq(radSolveWithFactors(solution, factors), -1);
        expect_error(device, RAD_ERROR_INVALID_ARGUMENT, "it takes a finite number from 0");
        factors[count / 2] = good;
    }
    ck_assert_int_eq(radSolveWithFactors(solution, factors), 0);
    ck_assert_int_eq(radGetPolygonValues(solution, 0, after, NULL), 0);
    for (int i = 0; i < 6; i++)
        ck_assert_double_eq_tol(after[i], before[i], 1e-10);
    for (size_t i = 0; i < count; i++)
        factors[i] *= 0.5F;
    ck_assert_int_eq(radSolveWithFactors(solution, factors), 0);
    ck_assert_int_eq(radGetPolygonValues(solution, 0, after, NULL), 0);
    for (int i = 0; i < 6; i++)
        ck_assert(after[i] <= before[i] && after[i] >= 0);
    memset(factors, 0, count * sizeof *factors);
    ck_assert_int_eq(radSolveWithFactors(solution, factors), 0);
    radGetElements(solution, &x);
    radGetLinks(solution, &links);
    ck_assert_uint_eq(links.count, count);
    for (uint32_t e = 0; e < x.count; e++)
        ck_assert_double_eq(x.irradiance[e], 0);
    ck_assert_int_eq(radStep(solution), 0);
    ck_assert_int_eq(radSolve(solution), 0);
    radGetElements(solution, &x);
    ck_assert_double_eq(x.irradiance[x.face_element[0]], 0);
    free(factors);
    radReleaseSolution(solution);
    radReleaseOracle(oracle);
    radReleaseScene(scene);
    radReleaseDevice(device);
}
END_TEST

static void expect_measured(RadSolution solution)
{
    ck_assert_int_eq(radMeasureError(solution, NULL, NULL), 0);
    ck_assert_ptr_nonnull(radGetElementErrors(solution));
    ck_assert_ptr_nonnull(radGetElementErrorLimits(solution));
}

/* Of polygons alone: the same of them, nothing of leaves, and no error. */
static void expect_polygons(RadDevice device, RadSolution solution)
{
    const struct RadMeasureOptions alone = {.polygons = 1};
    double error[2][6];
    expect_measured(solution);
    ck_assert_int_eq(radGetPolygonErrors(solution, 0, error[0], NULL), 0);
    ck_assert_int_eq(radMeasureError(solution, &alone, NULL), 0);
    ck_assert_int_eq(radGetPolygonErrors(solution, 0, error[1], NULL), 0);
    ck_assert_mem_eq(error[1], error[0], sizeof error[0]);
    ck_assert_ptr_null(radGetElementErrors(solution));
    ck_assert_ptr_null(radGetElementErrorLimits(solution));
    ck_assert_int_eq(radGetDeviceError(device), RAD_ERROR_NONE);
}

static void expect_unmeasured(RadDevice device, RadSolution solution)
{
    double error[6];
    ck_assert_ptr_null(radGetElementErrors(solution));
    ck_assert_ptr_null(radGetElementErrorLimits(solution));
    ck_assert_int_eq(radGetPolygonErrors(solution, 0, error, NULL), -1);
    expect_error(device, RAD_ERROR_INVALID_OPERATION, "nothing has been measured of what is shown");
}

/* An error is of the light it was measured of: whatever changes that light forgets it, and what
 * changes nothing does not. */
START_TEST(test_measured_is_forgotten)
{
    RadDevice device = radNewDevice(NULL);
    RadScene scene = lamp_scene(device, 0.5);
    RadOracle oracle = default_oracle(device);
    RadSolution solution = radNewSolution(scene, oracle, NULL);
    ck_assert_int_eq(radStep(solution), 1);
    expect_measured(solution);
    ck_assert_int_ge(radStep(solution), 0);
    expect_unmeasured(device, solution);
    expect_polygons(device, solution);
    radReleaseSolution(solution);

    solution = radNewSolution(scene, oracle, NULL);
    ck_assert_int_eq(radStep(solution), 1);
    expect_measured(solution);
    ck_assert_int_eq(radSolve(solution), 0);
    expect_unmeasured(device, solution);
    expect_measured(solution);
    ck_assert_int_eq(radSolve(solution), 0);
    ck_assert_ptr_nonnull(radGetElementErrors(solution));
    struct RadLinks links;
    radGetLinks(solution, &links);
    float *factors = calloc(links.count, sizeof *factors);
    ck_assert_ptr_nonnull(factors);
    ck_assert_int_eq(radSolveWithFactors(solution, factors), 0);
    expect_unmeasured(device, solution);
    free(factors);
    radReleaseSolution(solution);
    radReleaseOracle(oracle);
    radReleaseScene(scene);
    radReleaseDevice(device);
}
END_TEST

/* Bent, concave, two-sided and empty polygons; the arrays may go after the commit. */
START_TEST(test_polygons)
{
    static const uint32_t sizes[5] = {4, 5, 3, 2, 4};
    double *p = malloc(sizeof(double) * 3 * 12);
    uint32_t indices[18] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 0, 0, 1, 0, 1, 9, 10, 11, 2},
             materials[5] = {0, 1, 0, 0, 2};
    const double at[36] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, /* a square */
                           /* concave, 3 m2, two-sided */
                           5, 0, 0, 7, 0, 0, 7, 2, 0, 6, 1, 0, 5, 2, 0,
                           /* bent, with (1 1 0) */
                           1, 0, 3, 0, 0, 3, 0, 1, 3.5};
    const struct RadMaterial m[3] = {grey(0.5, 1), {{0.5, 0.5, 0.5}, {0, 0, 0}, 1}, grey(0, 0)};
    RadDevice device = radNewDevice(NULL);
    memcpy(p, at, sizeof at);
    const struct RadPolygons polygons = {.positions = p,
                                         .position_count = 12,
                                         .indices = indices,
                                         .sizes = sizes,
                                         .materials = materials,
                                         .count = 5};
    RadScene scene = make_scene(device, &polygons, m, 3);
    free(p);
    memset(indices, 0xff, sizeof indices);
    struct RadSceneReport r;
    ck_assert_int_eq(radGetSceneReport(scene, &r), 0);
    ck_assert_uint_eq(r.polygons, 5);
    ck_assert_uint_eq(r.dropped, 2);
    const double *areas = radGetScenePolygonAreas(scene);
    ck_assert_double_eq_tol(areas[0], 1, 1e-12);
    ck_assert_double_eq_tol(areas[1], 3, 1e-12);
    ck_assert_double_eq(areas[2], 0);
    ck_assert_double_eq(areas[3], 0);
    ck_assert_double_eq_tol(r.area, areas[0] + 2 * areas[1] + areas[4], 1e-12);
    const struct RadFace *faces = radGetSceneFaces(scene);
    uint32_t backs = 0, black = 0;
    for (uint32_t i = 0; i < r.faces; i++) {
        ck_assert_uint_lt(faces[i].input, 5);
        ck_assert_uint_eq(faces[i].material, materials[faces[i].input]);
        ck_assert_uint_eq(faces[i].black, faces[i].input == 4);
        backs += faces[i].back;
        black += faces[i].black;
    }
    ck_assert_uint_eq(backs, 3); /* three triangles */
    ck_assert_uint_eq(black, 2);
    ck_assert_double_eq(radGetSceneMaterials(scene)[2].reflectance[0], 0);
    radReleaseScene(scene);
    radReleaseDevice(device);
}
END_TEST

/* ---- exchange areas */

START_TEST(test_exchange)
{
    static const double opposite = 0.1998248957, beside = 0.2000437761;
    RadDevice device = radNewDevice(NULL);
    RadScene scene = lamp_scene(device, 0.5);
    for (int closure = RAD_CLOSURE_NONE; closure <= RAD_CLOSURE_RECIPROCAL; closure++) {
        const struct RadExchangeOptions o = {.closure = (enum RadClosure)closure};
        RadExchange x = radNewExchange(scene, NULL, &o);
        ck_assert_ptr_nonnull(x);
        double f[6][6];
        for (uint32_t i = 0; i < 6; i++) {
            double sum = radGetExchangeRow(x, i, f[i]), added = 0;
            for (int j = 0; j < 6; j++)
                added += f[i][j];
            ck_assert_double_eq_tol(sum, added, 1e-15);
            ck_assert_double_eq_tol(sum, 1, closure == RAD_CLOSURE_NONE ? 3e-4 : 1e-9);
        }
        for (int i = 0; i < 6; i++)
            for (int j = 0; j < 6; j++) {
                int across = i != j && (i < 2 ? j < 2 : j >= 2 && (i - j == 2 || j - i == 2));
                ck_assert_double_eq_tol(f[i][j], i == j ? 0 : across ? opposite : beside, 1e-4);
                ck_assert_double_eq_tol(f[i][j], f[j][i], 1e-12);
            }
        struct RadExchangeReport r;
        radGetExchangeReport(x, &r);
        ck_assert_uint_eq(r.rows_closed, 6);
        ck_assert_uint_eq(r.rows_open, 0);
        ck_assert_double_eq(radGetExchangeRow(x, 6, f[0]), -1);
        expect_error(device, RAD_ERROR_INVALID_ARGUMENT, "no row 6");
        radReleaseExchange(x);
    }
    radReleaseScene(scene);
    radReleaseDevice(device);
}
END_TEST

/* ---- references */

/* The cube whose ceiling emits: its continuous solution, rho = 1/2. */
START_TEST(test_reference)
{
    static const double wanted[3] = {1.1043616, 0.1712161, 0.1811056}; /* lamp, across, beside */
    RadDevice device = radNewDevice(NULL);
    RadScene scene = lamp_scene(device, 0.5);
    RadReference x = radNewReference(scene);
    radReleaseScene(scene);
    ck_assert_int_eq(radTraceReference(x, RAD_METHOD_PARTICLES, 1 << 17), 0);
    ck_assert_int_eq(radTraceReference(x, RAD_METHOD_PATHS, 1 << 16), 0);
    ck_assert_int_eq(radTraceReference(x, RAD_METHOD_PATHS, 1000), 0); /* there are as many */
    double b[6], se[6], again[6];
    for (int way = 0; way < RAD_METHODS; way++) {
        ck_assert_int_eq(radGetReferenceValues(x, (enum RadMethod)way, 0, b, se), 0);
        int lamp = b[1] > b[0];
        for (int i = 0; i < 6; i++) {
            double want = wanted[i == lamp ? 0 : i < 2 ? 1 : 2];
            ck_assert_double_eq_tol(b[i], want, 5 * se[i]);
            ck_assert_double_lt(se[i], 0.02 * want);
        }
    }
    struct RadReferenceReport r;
    ck_assert_int_eq(radGetReferenceReport(x, &r), 0);
    ck_assert_uint_eq(r.traced[RAD_METHOD_PARTICLES], 1 << 17);
    ck_assert_uint_eq(r.traced[RAD_METHOD_PATHS], 1 << 16);
    ck_assert_uint_gt(r.rays[0], 1 << 17);
    ck_assert_double_eq_tol(r.emitted, 1, 1e-12);
    ck_assert_double_eq_tol(r.reflected, 1, 0.01);
    ck_assert(r.noise[2] > 0 && r.noise[2] < r.noise[0] && r.noise[2] < r.noise[1]);
    ck_assert_double_lt(fabs(r.difference), 4 * r.deviation);
    /* saved and loaded */
    size_t size = radSaveReference(x, NULL, 0);
    unsigned char *bytes = malloc(size);
    ck_assert_uint_eq(radSaveReference(x, bytes, size), size);
    RadReference y = radNewReference(scene);
    ck_assert_int_eq(radLoadReference(y, bytes, size), 0);
    ck_assert_int_eq(radGetReferenceValues(y, RAD_METHOD_BOTH, 0, again, NULL), 0);
    ck_assert(memcmp(b, again, sizeof b) == 0);
    ck_assert_int_eq(radLoadReference(y, bytes, size - 1), -1);
    expect_error(device, RAD_ERROR_INVALID_ARGUMENT, "damaged");
    ck_assert_int_eq(radLoadReference(y, NULL, 0), -1);
    expect_error(device, RAD_ERROR_INVALID_ARGUMENT, "no bytes");
    free(bytes);
    /* what it does not take */
    ck_assert_int_eq(radTraceReference(y, RAD_METHOD_BOTH, 1), -1);
    expect_error(device, RAD_ERROR_INVALID_ARGUMENT, "RAD_METHOD_PATHS");
    ck_assert_int_eq(radTraceReference(y, RAD_METHOD_PARTICLES, UINT64_MAX), -1);
    expect_error(device, RAD_ERROR_INVALID_ARGUMENT, "told apart");
    ck_assert_int_eq(radGetReferenceValues(y, RAD_METHOD_PATHS, 1, b, se), -1);
    expect_error(device, RAD_ERROR_INVALID_ARGUMENT, "no band 1");
    ck_assert_int_eq(radGetReferenceValues(y, RAD_METHODS, 0, b, se), -1);
    expect_error(device, RAD_ERROR_INVALID_ARGUMENT, "enum RadMethod");
    radRetainReference(y);
    radReleaseReference(y);
    ck_assert_int_eq(radGetReferenceReport(y, &r), 0);
    radReleaseReference(y);
    radReleaseReference(x);
    radReleaseDevice(device);
}
END_TEST

/* A solution of one element per face, whose error is known: B of it less the continuous one. */
START_TEST(test_error_by_reference)
{
    static const double wanted[3] = {1.1043616, 0.1712161, 0.1811056}; /* lamp, across, beside */
    RadDevice device = radNewDevice(NULL);
    RadScene scene = lamp_scene(device, 0.5), other = lamp_scene(device, 0.25);
    RadOracle oracle = radNewOracle(device, "ff", RAD_RELEASE_FLAT);
    ck_assert_int_eq(radSetOracleParameter(oracle, "limit", 2), 0);
    RadSolution solution = radNewSolution(scene, oracle, NULL);
    RadReference x = radNewReference(scene), none = radNewReference(scene),
                 foreign = radNewReference(other);
    struct RadErrorReport e;
    ck_assert_int_eq(radTraceReference(x, RAD_METHOD_PARTICLES, 1 << 18), 0);
    ck_assert_int_eq(radTraceReference(foreign, RAD_METHOD_PARTICLES, 1 << 12), 0);
    ck_assert_int_eq(radMeasureErrorBy(solution, x, &e), -1);
    expect_error(device, RAD_ERROR_INVALID_OPERATION, "radSolve or radStep");
    ck_assert_int_eq(radSolve(solution), 0);
    ck_assert_int_eq(radMeasureErrorBy(solution, none, &e), -1);
    expect_error(device, RAD_ERROR_INVALID_OPERATION, "radTraceReference");
    ck_assert_int_eq(radMeasureErrorBy(solution, foreign, &e), -1);
    expect_error(device, RAD_ERROR_INVALID_ARGUMENT, "another scene");
    ck_assert_int_eq(radMeasureErrorBy(solution, NULL, &e), -1);
    RadSolution unit = radNewSolution(scene, oracle, &(struct RadSolveOptions){.unit = 1});
    ck_assert_int_eq(radSolve(unit), 0);
    ck_assert_int_eq(radMeasureErrorBy(unit, x, &e), -1);
    expect_error(device, RAD_ERROR_INVALID_OPERATION, "RadSolveOptions.unit");
    radReleaseSolution(unit);

    double b[6], off = 0, more = 0;
    ck_assert_int_eq(radGetPolygonValues(solution, 0, b, NULL), 0);
    int lamp = b[1] > b[0];
    for (int i = 0; i < 6; i++) {
        double want = wanted[i == lamp ? 0 : i < 2 ? 1 : 2];
        off += fabs(b[i] - want); /* 1 W is reflected */
        more += b[i] - want;
    }
    ck_assert_double_gt(off, 0.005);
    ck_assert_int_eq(radMeasureErrorBy(solution, x, &e), 0);
    ck_assert_double_eq_tol(e.reflected, 1, 0.01);
    ck_assert_msg(e.l1_faces.low <= off && off <= e.l1_faces.high, "%g is not within %g and %g",
                  off, e.l1_faces.low, e.l1_faces.high);
    ck_assert(e.power.low <= more && more <= e.power.high);
    ck_assert_double_lt(e.l1_faces.high - e.l1_faces.low, 0.01);
    ck_assert_uint_eq(e.particles, 1 << 18);
    ck_assert_uint_gt(e.rays, e.particles);
    radReleaseReference(foreign);
    radReleaseReference(none);
    radReleaseReference(x);
    radReleaseSolution(solution);
    radReleaseOracle(oracle);
    radReleaseScene(other);
    radReleaseScene(scene);
    radReleaseDevice(device);
}
END_TEST

/* ---- oracles */

/* What the oracle `graph` decides of a pair, by a release; NULL graphs are reported. */
static int decides(RadDevice device, enum RadRelease release)
{
    static const char graph[] = "extern twice() : ratio in [0, inf]; oracle a { start b;"
                                " node b = above(value = twice, limit = 1) "
                                "{ yes -> v; no -> stop; } "
                                "node v = presume_visible() { done -> link_clusters; } }";
    const struct element receiver = {.area = 0.75}, emitter = {.area = 0.25};
    const struct host host = {.area = 1};
    struct discussion d = {.receiver = &receiver, .emitter = &emitter, .host = &host};
    RadOracle oracle = radParseOracle(device, "mine", graph, NULL, release);
    int decision = oracle ? (int)radAskOracle(oracle, &d) : -1;
    radReleaseOracle(oracle);
    return decision;
}

static const char *written(const char *name, const char *text)
{
    static char path[200];
    const char *folder = getenv("TMPDIR");
    snprintf(path, sizeof path, "%s/%d_%s", folder ? folder : "/tmp", (int)getpid(), name);
    FILE *file = fopen(path, "w");
    ck_assert_ptr_nonnull(file);
    ck_assert_int_ge(fputs(text, file), 0);
    ck_assert_int_eq(fclose(file), 0);
    return path;
}

START_TEST(test_plugins)
{
    static const enum RadRelease both[] = {RAD_RELEASE_FLAT, RAD_RELEASE_DAG};
    RadDevice device = radNewDevice(NULL);
    for (int i = 0; i < 2; i++) {
        ck_assert_int_eq(decides(device, both[i]), -1);
        expect_error(device, RAD_ERROR_INVALID_ORACLE,
                     "mine:1:8: error: nothing defines the extern");
    }
    ck_assert_int_eq(radLoadPlugin(NULL, "x.c"), -1);
    ck_assert_int_eq(radLoadPlugin(device, NULL), -1);
    expect_error(device, RAD_ERROR_INVALID_ARGUMENT, "name");
    ck_assert_int_eq(radLoadPlugin(device, "nowhere.c"), -1);
    expect_error(device, RAD_ERROR_INVALID_ARGUMENT, "cannot read");
    const char *path = written("wrong.c", "int x = ;\n");
    ck_assert_int_eq(radLoadPlugin(device, path), -1);
    expect_error(device, RAD_ERROR_UNSUPPORTED, "wrong.c:1:9: error");
    remove(path);
    path = written("twice.c", "#include \"discussion.h\"\n"
                              "double twice(const struct discussion *d)\n"
                              "{ return 2 * d->receiver->area; }\n");
    ck_assert_msg(radLoadPlugin(device, path) == 0, "%s", radGetDeviceErrorMessage(device));
    remove(path);
    for (int i = 0; i < 2; i++)
        ck_assert_int_eq(decides(device, both[i]), DECISION_LINK_CLUSTERS);
    path = written("less.c", "#include \"discussion.h\"\n"
                             "double twice(const struct discussion *d)\n"
                             "{ return 2 * d->emitter->area; }\n");
    ck_assert_int_eq(radLoadPlugin(device, path), 0); /* the last one counts */
    remove(path);
    for (int i = 0; i < 2; i++)
        ck_assert_int_eq(decides(device, both[i]), DECISION_STOP);
    radReleaseDevice(device);
}
END_TEST

START_TEST(test_oracles)
{
    RadDevice device = radNewDevice(NULL);
    struct RadOracleReport r;
    int found = 0;
    for (const char *const *name = radGetOracleNames(); *name; name++) {
        RadOracle oracle = radNewOracle(device, *name, RAD_RELEASE_DAG);
        ck_assert_ptr_nonnull(oracle);
        radGetOracleReport(oracle, &r);
        ck_assert_str_eq(r.name, *name);
        ck_assert_int_eq(radHasOracle(device, *name, RAD_RELEASE_FLAT), 1);
        ck_assert_int_eq(r.reads_importance, strcmp(*name, "importance") == 0
                                                 || strcmp(*name, "ranked") == 0
                                                 || strcmp(*name, "bracket") == 0);
        found += strcmp(*name, radGetDefaultOracle()) == 0;
        radReleaseOracle(oracle);
    }
    ck_assert_int_eq(found, 1);
    RadOracle text =
        radParseOracle(device, "text", radGetOracleText("clusters"), NULL, RAD_RELEASE_DAG);
    ck_assert_msg(text != NULL, "%s", radGetDeviceErrorMessage(device)); /* it stands alone */
    radReleaseOracle(text);
    ck_assert_ptr_null(radGetOracleText("nobody"));
    ck_assert_ptr_null(radGetOracleText(NULL));
    ck_assert_ptr_null(radNewOracle(device, "nobody", RAD_RELEASE_FLAT));
    expect_error(device, RAD_ERROR_INVALID_ARGUMENT, "no built-in oracle 'nobody'");
    ck_assert_ptr_null(radNewOracle(device, "bf", RAD_RELEASE_HAND));
    expect_error(device, RAD_ERROR_INVALID_ARGUMENT, "registered");
    ck_assert_ptr_null(radNewOracle(device, "bf", (enum RadRelease)7));
    expect_error(device, RAD_ERROR_INVALID_ARGUMENT, "release");
    ck_assert_ptr_null(radLoadOracle(device, "nowhere.dag", NULL, RAD_RELEASE_DAG));
    expect_error(device, RAD_ERROR_INVALID_ORACLE, "nowhere.dag");
    ck_assert_ptr_null(
        radParseOracle(device, "mine", "oracle a { start b; }", NULL, RAD_RELEASE_DAG));
    expect_error(device, RAD_ERROR_INVALID_ORACLE, "mine:1:");
    RadOracle own = radParseOracle(device, "mine",
                                   "oracle a \"one\" { param x : ratio = 0.25 in [0, 1];"
                                   " fixed param z : ratio = 3 in [0, 9]; start t; node t = "
                                   "transfer(relative = z * x) { otherwise -> stop; } }",
                                   NULL, RAD_RELEASE_DAG);
    ck_assert_msg(own != NULL, "%s", radGetDeviceErrorMessage(device));
    radGetOracleReport(own, &r);
    ck_assert_str_eq(r.doc, "one");
    ck_assert_int_eq(r.parameter_count, 2);
    ck_assert_int_eq(r.parameters[0].fixed, 0);
    ck_assert_int_eq(r.parameters[1].fixed, 1);
    ck_assert_int_eq(radSetOracleParameter(own, "z", 3), -1);
    expect_error(device, RAD_ERROR_INVALID_ARGUMENT, "z is fixed by the author of oracle a, at 3");
    ck_assert_double_eq(radGetOracleParameter(own, "x"), 0.25);
    ck_assert_int_eq(radSetOracleParameter(own, "x", 0.5), 0);
    ck_assert_double_eq(radGetOracleParameter(own, "x"), 0.5);
    ck_assert_int_eq(radSetOracleParameter(own, "x", 2), -1);
    expect_error(device, RAD_ERROR_INVALID_ARGUMENT, "x takes 0 to 1");
    ck_assert_int_eq(radSetOracleParameter(own, "x", (double)NAN), -1);
    expect_error(device, RAD_ERROR_INVALID_ARGUMENT, "x takes 0 to 1");
    ck_assert_int_eq(radSetOracleParameter(own, "y", 1), -1);
    expect_error(device, RAD_ERROR_INVALID_ARGUMENT, "no parameter 'y'; it has x, z");
    ck_assert_double_nan(radGetOracleParameter(own, "y"));
    radReleaseOracle(own);
    RadOracle flat = radParseOracle(device, "mine",
                                    "oracle a { fixed param z : ratio = 3 in [0, 4]; start t;"
                                    " node t = transfer(relative = z) { otherwise -> stop; } }",
                                    NULL, RAD_RELEASE_FLAT);
    ck_assert_msg(flat != NULL, "%s", radGetDeviceErrorMessage(device));
    radGetOracleReport(flat, &r);
    ck_assert_str_eq(r.release, "flat");
    ck_assert_int_eq(r.parameters[0].fixed, 1);
    ck_assert_int_eq(radSetOracleParameter(flat, "z", 2), -1);
    ck_assert_double_eq(radGetOracleParameter(flat, "z"), 3);
    ck_assert_int_gt((int)strlen(r.fingerprint), 0);
    radReleaseOracle(flat);
    radReleaseDevice(device);
    device = radNewDevice(&(struct RadDeviceOptions){.compiler = "no-such-compiler"});
    ck_assert_ptr_null(radParseOracle(
        device, "mine",
        "oracle a { start t; node t = transfer(relative = 1) { otherwise -> stop; } }", NULL,
        RAD_RELEASE_FLAT));
    expect_error(device, RAD_ERROR_UNSUPPORTED, "no-such-compiler");
    radReleaseDevice(device);
}
END_TEST

/* A host that ignores its children's ends does not learn how the compiler ended. */
START_TEST(test_children_ignored)
{
    static const char text[] =
        "oracle a { start t; node t = transfer(relative = 1) { otherwise -> stop; } }";
    void (*before)(int) = signal(SIGCHLD, SIG_IGN);
    RadDevice device = radNewDevice(NULL);
    RadOracle flat = radParseOracle(device, "mine", text, NULL, RAD_RELEASE_FLAT);
    ck_assert_msg(flat != NULL, "%s", radGetDeviceErrorMessage(device));
    radReleaseOracle(flat);
    radReleaseDevice(device);
    device = radNewDevice(&(struct RadDeviceOptions){.compiler = "false"});
    ck_assert_ptr_null(radParseOracle(device, "mine", text, NULL, RAD_RELEASE_FLAT));
    expect_error(device, RAD_ERROR_UNSUPPORTED, "'false' failed");
    radReleaseDevice(device);
    signal(SIGCHLD, before);
}
END_TEST

static void nothing(void *parameters)
{
    (void)parameters;
}

static enum decision link_all(const void *parameters, struct discussion *d)
{
    (void)parameters;
    return d->receiver == d->emitter && !d->receiver->vertices ? DECISION_SUBDIVIDE_BOTH
                                                               : DECISION_STOP;
}

START_TEST(test_registered)
{
    struct oracle hand = {.abi = RUNTIME_ABI,
                          .name = "mine",
                          .doc = "",
                          .fingerprint = "",
                          .parameters_size = 1,
                          .defaults = nothing,
                          .refine = link_all};
    RadDevice device = radNewDevice(NULL);
    ck_assert_int_eq(radHasOracle(device, "mine", RAD_RELEASE_HAND), 0);
    ck_assert_int_eq(radRegisterOracle(device, &hand), 0);
    ck_assert_int_eq(radHasOracle(device, "mine", RAD_RELEASE_HAND), 1);
    ck_assert_int_eq(radHasOracle(device, "mine", RAD_RELEASE_FLAT), 0);
    RadOracle oracle = radNewOracle(device, "mine", RAD_RELEASE_HAND);
    ck_assert_ptr_nonnull(oracle);
    struct RadOracleReport r;
    radGetOracleReport(oracle, &r);
    ck_assert_str_eq(r.release, "hand");
    RadScene scene = lamp_scene(device, 0.5);
    RadSolution solution = radNewSolution(scene, oracle, NULL);
    ck_assert_int_eq(radSolve(solution), 0); /* no links, B = E */
    double b[6];
    ck_assert_int_eq(radGetPolygonValues(solution, 0, b, NULL), 0);
    ck_assert_double_eq(b[0], 1);
    ck_assert_double_eq(b[1], 0);
    radReleaseSolution(solution);
    radReleaseScene(scene);
    radReleaseOracle(oracle);
    hand.abi = RUNTIME_ABI + 1;
    ck_assert_ptr_null(radNewOracleCompiled(device, &hand, "flat"));
    expect_error(device, RAD_ERROR_INVALID_ORACLE, "ABI");
    ck_assert_int_eq(radRegisterOracle(device, &hand), -1);
    expect_error(device, RAD_ERROR_INVALID_ORACLE, "ABI");
    radReleaseDevice(device);
}
END_TEST

START_TEST(test_statistics)
{
    RadDevice device = radNewDevice(NULL);
    RadScene scene = lamp_scene(device, 0.5);
    RadOracle oracle = radNewOracle(device, radGetDefaultOracle(), RAD_RELEASE_DAG),
              flat = default_oracle(device);
    RadSolution solution = radNewSolution(scene, oracle, NULL),
                same = radNewSolution(scene, flat, NULL);
    struct RadStatistics s;
    double a[6], b[6];
    ck_assert_int_eq(radGetOracleStatistics(oracle, &s), -1);
    expect_error(device, RAD_ERROR_INVALID_OPERATION, "radCountOracle");
    ck_assert_int_eq(radCountOracle(flat), -1);
    expect_error(device, RAD_ERROR_INVALID_OPERATION, "RAD_RELEASE_DAG");
    ck_assert_int_eq(radCountOracle(oracle), 0);
    ck_assert_int_eq(radSolve(solution), 0);
    ck_assert_int_eq(radSolve(same), 0);
    ck_assert_int_eq(radGetOracleStatistics(oracle, &s), 0);
    struct RadReport r;
    radGetReport(solution, &r);
    ck_assert_int_gt(s.node_count, 1);
    ck_assert_uint_eq(s.nodes[0].calls, r.pairs);
    for (int i = 0; i < s.node_count; i++) {
        uint64_t sum = 0;
        for (int k = 0; k < s.nodes[i].answer_count; k++)
            sum += s.nodes[i].answers[k].count;
        ck_assert_uint_eq(sum, s.nodes[i].calls);
    }
    ck_assert_int_eq(radGetPolygonValues(solution, 0, a, NULL), 0);
    ck_assert_int_eq(radGetPolygonValues(same, 0, b, NULL), 0);
    /* the two releases decide alike, and counting changes nothing */
    ck_assert_int_eq(memcmp(a, b, sizeof a), 0);
    radReleaseSolution(solution);
    radReleaseSolution(same);
    radReleaseOracle(oracle);
    radReleaseOracle(flat);
    radReleaseScene(scene);
    radReleaseDevice(device);
}
END_TEST

/* ---- errors */

START_TEST(test_no_handle)
{
    ck_assert_ptr_null(radNewDevice(&(struct RadDeviceOptions){.threads = -1}));
    expect_error(NULL, RAD_ERROR_INVALID_ARGUMENT, "threads");
    radRetainDevice(NULL);
    radReleaseDevice(NULL);
    radSetDeviceMessageFunction(NULL, NULL, NULL);
    radSetDeviceProgressFunction(NULL, NULL, NULL);
    ck_assert_ptr_null(radNewScene(NULL));
    radRetainScene(NULL);
    radReleaseScene(NULL);
    ck_assert_int_eq(radSetSceneMaterials(NULL, NULL, 0), -1);
    ck_assert_int_eq(radSetSceneSharedPolygons(NULL, NULL), -1);
    ck_assert_int_eq(radCommitScene(NULL), -1);
    struct RadSceneReport scene;
    ck_assert_int_eq(radGetSceneReport(NULL, &scene), -1);
    ck_assert_ptr_null(radGetSceneFaces(NULL));
    ck_assert_ptr_null(radGetScenePolygonAreas(NULL));
    ck_assert_ptr_null(radGetSceneMaterials(NULL));
    ck_assert_ptr_null(radNewOracle(NULL, "bf", RAD_RELEASE_FLAT));
    ck_assert_ptr_null(radLoadOracle(NULL, "bf", NULL, RAD_RELEASE_FLAT));
    ck_assert_ptr_null(radParseOracle(NULL, "bf", "", NULL, RAD_RELEASE_DAG));
    ck_assert_ptr_null(radNewOracleCompiled(NULL, NULL, NULL));
    ck_assert_int_eq(radRegisterOracle(NULL, NULL), -1);
    ck_assert_int_eq(radHasOracle(NULL, NULL, RAD_RELEASE_FLAT), 0);
    radRetainOracle(NULL);
    radReleaseOracle(NULL);
    struct RadOracleReport oracle;
    radGetOracleReport(NULL, &oracle);
    ck_assert_int_eq(oracle.parameter_count, 0);
    ck_assert_int_eq(radSetOracleParameter(NULL, "x", 1), -1);
    ck_assert_double_nan(radGetOracleParameter(NULL, "x"));
    ck_assert_int_eq(radAskOracle(NULL, NULL), DECISION_STOP);
    ck_assert_int_eq(radCountOracle(NULL), -1);
    struct RadStatistics statistics;
    ck_assert_int_eq(radGetOracleStatistics(NULL, &statistics), -1);
    ck_assert_ptr_null(radNewSolution(NULL, NULL, NULL));
    radRetainSolution(NULL);
    radReleaseSolution(NULL);
    ck_assert_int_eq(radRefine(NULL), -1);
    ck_assert_int_eq(radStep(NULL), -1);
    ck_assert_int_eq(radSolve(NULL), -1);
    double row[6];
    ck_assert_int_eq(radGetPolygonValues(NULL, 0, row, row), -1);
    struct RadElements elements;
    radGetElements(NULL, &elements);
    struct RadLinks links;
    radGetLinks(NULL, &links);
    struct RadReport report;
    radGetReport(NULL, &report);
    ck_assert_uint_eq(elements.count + links.count + report.elements, 0);
    ck_assert_ptr_null(radNewExchange(NULL, NULL, NULL));
    radRetainExchange(NULL);
    radReleaseExchange(NULL);
    ck_assert_double_eq(radGetExchangeRow(NULL, 0, row), -1);
    struct RadExchangeReport exchange;
    radGetExchangeReport(NULL, &exchange);
    ck_assert_uint_eq(exchange.links, 0);
    struct RadReferenceReport reference;
    ck_assert_ptr_null(radNewReference(NULL));
    radRetainReference(NULL);
    radReleaseReference(NULL);
    ck_assert_int_eq(radTraceReference(NULL, RAD_METHOD_PATHS, 1), -1);
    ck_assert_int_eq(radGetReferenceValues(NULL, RAD_METHOD_PATHS, 0, row, row), -1);
    ck_assert_int_eq(radGetReferenceReport(NULL, &reference), -1);
    ck_assert_uint_eq(radSaveReference(NULL, NULL, 0), 0);
    ck_assert_int_eq(radLoadReference(NULL, row, sizeof row), -1);
    ck_assert_ptr_null(radGetClusteringDoc("nobody"));
    ck_assert_ptr_null(radGetClusteringDoc(NULL));
    for (const char *const *name = radGetClusteringNames(); *name; name++)
        ck_assert_ptr_nonnull(radGetClusteringDoc(*name));
}
END_TEST

/* Where a call's caller gives no place for what it returns, the device says so. */
START_TEST(test_no_place)
{
    RadDevice device = radNewDevice(NULL);
    RadScene scene = lamp_scene(device, 0.5);
    RadOracle oracle = default_oracle(device);
    RadSolution solution = radNewSolution(scene, oracle, NULL);
    RadReference reference = radNewReference(scene);
    RadExchange exchange = radNewExchange(scene, NULL, NULL);
    const double at[3] = {0, 0, 0};
    const char *const nothing[1] = {NULL};
    struct discussion pair = {0};
    char name[RAD_NAME];
    uint32_t element;
    ck_assert_int_eq(radSolve(solution), 0);
    ck_assert_ptr_nonnull(exchange);
#define REFUSED(call) \
    do { \
        ck_assert_int_eq(call, -1); \
        expect_error(device, RAD_ERROR_INVALID_ARGUMENT, "which is NULL"); \
    } while (0)
    enum decision decisions[2] = {DECISION_LINK, DECISION_LINK};
    radAskOracles(oracle, NULL, 2, decisions);
    ck_assert(decisions[0] == DECISION_STOP && decisions[1] == DECISION_STOP);
    radAskOracles(oracle, NULL, 2, NULL);
    ck_assert_int_eq(radListOracleFiles("examples/oracles/bf.dag", NULL, NULL), 0);
    REFUSED(radGetSceneReport(scene, NULL));
    REFUSED(radFindCauses(solution, NULL, NULL));
    REFUSED(radAccountErrors(solution, NULL, NULL));
    REFUSED(radGetSolutionState(solution, NULL));
    REFUSED(radSetSolutionState(solution, NULL));
    REFUSED(radGetElementName(solution, 0, NULL));
    REFUSED(radFindElement(solution, NULL, &element));
    REFUSED(radFindElement(solution, "root", NULL));
    REFUSED(radFindFaceAt(solution, NULL, &element));
    REFUSED(radFindFaceAt(solution, at, NULL));
    REFUSED(radExplain(solution, NULL, &pair, NULL));
    REFUSED(radExplain(solution, oracle, NULL, NULL));
    REFUSED(radExplain(solution, oracle, &pair, NULL));
    struct RadExplanation explanation;
    static const struct element some;
    static const struct host facts;
    const struct discussion lacks[] = {{0},
                                       {.emitter = &some, .host = &facts},
                                       {.receiver = &some, .host = &facts},
                                       {.receiver = &some, .emitter = &some}};
    for (size_t i = 0; i < sizeof lacks / sizeof *lacks; i++)
        REFUSED(radExplain(solution, oracle, &lacks[i], &explanation));
    REFUSED(radGetOracleStatistics(oracle, NULL));
    REFUSED(radGetExchangeLoss(exchange, 0, NULL));
    REFUSED(radGetReferenceReport(reference, NULL));
    REFUSED(radMeasureErrorBy(solution, reference, NULL));
#undef REFUSED
    ck_assert_int_eq(radGetElementName(solution, 0, name), 0);
    ck_assert_ptr_null(radLoadOracleReplaced(device, "bf", NULL, RAD_RELEASE_FLAT, nothing, 1));
    expect_error(device, RAD_ERROR_INVALID_ARGUMENT, "replacements");
    radReleaseExchange(exchange);
    radReleaseReference(reference);
    radReleaseSolution(solution);
    radReleaseOracle(oracle);
    radReleaseScene(scene);
    radReleaseDevice(device);
}
END_TEST

static void expect_bad_scene(RadDevice device, const struct RadPolygons *polygons,
                             const struct RadMaterial *material, const char *part)
{
    RadScene scene = radNewScene(device);
    ck_assert_int_eq(radSetSceneMaterials(scene, material, 1), 0);
    ck_assert_int_eq(radSetSceneSharedPolygons(scene, polygons), 0);
    ck_assert_int_eq(radCommitScene(scene), -1);
    expect_error(device, RAD_ERROR_INVALID_SCENE, part);
    ck_assert_ptr_null(radNewSolution(scene, NULL, NULL));
    expect_error(device, RAD_ERROR_INVALID_OPERATION, "radCommitScene");
    radReleaseScene(scene);
}

START_TEST(test_bad_scenes)
{
    RadDevice device = radNewDevice(NULL);
    const struct RadMaterial good = grey(0.5, 1);
    struct RadMaterial m = grey(1, 0);
    struct RadPolygons p = cube(NULL);
    expect_bad_scene(device, &p, &m, "material 0 has reflectance 1");
    m = grey(-0.5, 0);
    expect_bad_scene(device, &p, &m, "material 0 has reflectance -0.5");
    m = grey((double)NAN, 0);
    expect_bad_scene(device, &p, &m, "reflectance");
    m = grey(0.5, -1);
    expect_bad_scene(device, &p, &m, "exitance -1");
    m = grey(0.5, (double)INFINITY);
    expect_bad_scene(device, &p, &m, "exitance inf");
    m = grey(0.5, 1e308); /* whose radiosity is beyond all numbers */
    expect_bad_scene(device, &p, &m,
                     "exitance 1e+308 W/m2; it must be 0 or more and finite, 3.4e38");
    m = grey(0.5, 1e-200); /* squares of whose powers are 0 */
    expect_bad_scene(device, &p, &m,
                     "the brightest exitance is 1e-200 W/m2, too little to compute with; it must "
                     "be 1.2e-38 or more, or 0 everywhere");
    expect_bad_scene(device,
                     &(struct RadPolygons){.positions = corners,
                                           .position_count = 8,
                                           .indices = sides,
                                           .size = 4,
                                           .materials = lamp_above,
                                           .count = 6},
                     &good, "material 1");
    RadScene turned = radNewScene(device);
    p.turned = (enum RadTurned)99;
    ck_assert_int_eq(radSetSceneSharedPolygons(turned, &p), -1);
    expect_error(device, RAD_ERROR_INVALID_ARGUMENT, "enum RadTurned");
    radReleaseScene(turned);
    p.turned = RAD_TURNED_IGNORE;
    double positions[24];
    memcpy(positions, corners, sizeof positions);
    positions[7] = (double)NAN;
    expect_bad_scene(device,
                     &(struct RadPolygons){.positions = positions,
                                           .position_count = 8,
                                           .indices = sides,
                                           .size = 4,
                                           .materials = NULL,
                                           .count = 6},
                     &good, "not finite");
    uint32_t indices[24];
    memcpy(indices, sides, sizeof indices);
    indices[9] = 8;
    expect_bad_scene(device,
                     &(struct RadPolygons){.positions = corners,
                                           .position_count = 8,
                                           .indices = indices,
                                           .size = 4,
                                           .materials = NULL,
                                           .count = 6},
                     &good, "8");
    memset(positions, 0, sizeof positions);
    expect_bad_scene(device,
                     &(struct RadPolygons){.positions = positions,
                                           .position_count = 8,
                                           .indices = sides,
                                           .size = 4,
                                           .materials = NULL,
                                           .count = 6},
                     &good, "degenerate");

    RadScene scene = radNewScene(device);
    ck_assert_int_eq(radCommitScene(scene), -1);
    expect_error(device, RAD_ERROR_INVALID_OPERATION, "materials");
    ck_assert_int_eq(radSetSceneMaterials(scene, NULL, 1), -1);
    expect_error(device, RAD_ERROR_INVALID_ARGUMENT, "material");
    ck_assert_int_eq(radSetSceneMaterials(scene, &good, 1), 0);
    ck_assert_int_eq(radCommitScene(scene), -1);
    expect_error(device, RAD_ERROR_INVALID_OPERATION, "polygons");
    ck_assert_int_eq(radSetSceneSharedPolygons(scene, &(struct RadPolygons){0}), -1);
    expect_error(device, RAD_ERROR_INVALID_ARGUMENT, "one polygon");
    p.size = 2;
    ck_assert_int_eq(radSetSceneSharedPolygons(scene, &p), -1);
    expect_error(device, RAD_ERROR_INVALID_ARGUMENT, "3 or more");
    p.size = 4;
    p.positions = NULL;
    ck_assert_int_eq(radSetSceneSharedPolygons(scene, &p), -1);
    expect_error(device, RAD_ERROR_INVALID_ARGUMENT, "positions");
    p.positions = corners;
    ck_assert_int_eq(radSetSceneSharedPolygons(scene, &p), 0);
    ck_assert_int_eq(radCommitScene(scene), 0);
    ck_assert_int_eq(radCommitScene(scene), -1);
    expect_error(device, RAD_ERROR_INVALID_OPERATION, "committed");
    ck_assert_int_eq(radSetSceneMaterials(scene, &good, 1), -1);
    expect_error(device, RAD_ERROR_INVALID_OPERATION, "committed");
    radReleaseScene(scene);
    radReleaseDevice(device);
}
END_TEST

/* Solver and projection are what was asked for and are reported, with what iteration was held to; a
 * scene that is too much for a matrix is told as such. */
START_TEST(test_solvers)
{
    RadDevice device = radNewDevice(NULL);
    RadScene scene = lamp_scene(device, 0.5);
    RadOracle oracle = radNewOracle(device, "bf_guarded", RAD_RELEASE_FLAT);
    double *mean[3];
    struct RadSceneReport of;
    radGetSceneReport(scene, &of);
    ck_assert_int_eq(radSetOracleParameter(oracle, "min_share", 5e-3), 0);
    for (int i = 0; i < 3; i++) {
        const struct RadSolveOptions how = {.tolerance = i ? 1e-9 : 0,
                                            .solver = i == 2 ? RAD_SOLVER_LU : RAD_SOLVER_SOUTHWELL,
                                            .projection = RAD_PROJECTION_COLLOCATION};
        RadSolution solution = radNewSolution(scene, oracle, &how);
        struct RadReport report;
        mean[i] = calloc(of.polygons, sizeof *mean[i]);
        ck_assert_int_eq(radSolve(solution), 0);
        ck_assert_int_eq(radGetPolygonValues(solution, 0, mean[i], NULL), 0);
        radGetReport(solution, &report);
        ck_assert_int_eq(report.converged, 1);
        ck_assert_int_eq(report.solver, how.solver);
        ck_assert_int_eq(report.projection, RAD_PROJECTION_COLLOCATION);
        ck_assert_double_le(report.solved.bound, report.solved.tolerance);
        if (i)
            ck_assert_double_eq(report.solved.tolerance, 1e-9);
        else
            ck_assert_double_le(fabs(log10(report.solved.tolerance) + 3.5), 0.5 + 1e-9);
        ck_assert((report.solved.variation > 0) == (i == 0));
        radReleaseSolution(solution);
    }
    for (uint32_t i = 0; i < of.polygons; i++) {
        ck_assert_double_eq_tol(mean[0][i], mean[1][i], 1e-2 * mean[1][i]);
        ck_assert_double_eq_tol(mean[1][i], mean[2][i], 1e-7 * mean[1][i]);
    }
    for (int i = 0; i < 3; i++)
        free(mean[i]);
    ck_assert_int_eq(radSetOracleParameter(oracle, "min_share", 2e-5), 0);
    ck_assert_int_eq(radSetOracleParameter(oracle, "relative", 1e-2), 0);
    RadSolution solution =
        radNewSolution(scene, oracle, &(struct RadSolveOptions){.solver = RAD_SOLVER_LU});
    ck_assert_int_eq(radSolve(solution), -1);
    expect_error(device, RAD_ERROR_INVALID_ARGUMENT, "LU solves for at most 5000 leaves");
    radReleaseSolution(solution);
    ck_assert_int_eq(radHasSolver(RAD_SOLVER_LU), 1);
    ck_assert_int_eq(radHasSolver((enum RadSolver)(RAD_SOLVER_PETSC + 1)), 0);
    ck_assert_int_eq(radHasSolver((enum RadSolver) - 1), 0);
    if (!radHasSolver(RAD_SOLVER_PETSC)) {
        const struct RadSolveOptions how = {.solver = RAD_SOLVER_PETSC};
        ck_assert_ptr_null(radNewSolution(scene, oracle, &how));
        expect_error(device, RAD_ERROR_UNSUPPORTED, "make PETSC=1");
    }
    radReleaseOracle(oracle);
    radReleaseScene(scene);
    radReleaseDevice(device);
}
END_TEST

START_TEST(test_bad_options)
{
    RadDevice device = radNewDevice(NULL);
    RadScene scene = lamp_scene(device, 0.5);
    RadOracle oracle = default_oracle(device);
    struct RadCamera camera = {{0.5, 0.5, 0.5}, {1, 0, 0}, {0, 0, 1}, {0, 2, 0}, 0.5, 0.5};
    const struct {
        struct RadSolveOptions o;
        const char *part;
    } bad[] = {
        {{.tolerance = -1}, "tolerance is -1"},
        {{.tolerance = (double)NAN}, "tolerance is"},
        {{.tolerance = 1}, "tolerance is 1"},
        {{.iterations = -1}, "iterations is -1"},
        {{.solver = (enum RadSolver)5}, "solver is 5"},
        {{.projection = (enum RadProjection)2}, "projection"},
        {{.closure = RAD_CLOSURE_RECIPROCAL}, "closure"},
        {{.clustering = "heap"}, "no clustering 'heap'"},
        {{.camera = &camera}, "length 1"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        ck_assert_ptr_null(radNewSolution(scene, oracle, &bad[i].o));
        expect_error(device, RAD_ERROR_INVALID_ARGUMENT, bad[i].part);
    }
    camera.ahead[1] = 1;
    camera.wide = 0;
    ck_assert_ptr_null(radNewSolution(scene, oracle, &(struct RadSolveOptions){.camera = &camera}));
    expect_error(device, RAD_ERROR_INVALID_ARGUMENT, "above 0");
    ck_assert_ptr_null(radNewSolution(scene, NULL, NULL));
    expect_error(device, RAD_ERROR_INVALID_ARGUMENT, "oracle");
    ck_assert_ptr_null(radNewExchange(scene, NULL, &(struct RadExchangeOptions){.tolerance = 2}));
    expect_error(device, RAD_ERROR_INVALID_ARGUMENT, "tolerance is 2");
    ck_assert_ptr_null(
        radNewExchange(scene, NULL, &(struct RadExchangeOptions){.closure = (enum RadClosure)9}));
    expect_error(device, RAD_ERROR_INVALID_ARGUMENT, "closure");
    RadSolution solution = radNewSolution(scene, oracle, NULL);
    double b[6];
    ck_assert_int_eq(radGetPolygonValues(solution, 1, b, NULL), -1);
    expect_error(device, RAD_ERROR_INVALID_ARGUMENT, "no band 1; there are 1");
    radReleaseSolution(solution);
    radReleaseOracle(oracle);
    radReleaseScene(scene);
    radReleaseDevice(device);
}
END_TEST

/* Particles tell how far they are: shares and rays rise, to all of them; other phases know none. */
struct course {
    int calls;
    double share;
    uint64_t rays;
};

static int follow(void *user, const struct RadProgress *p)
{
    struct course *course = user;
    if (strcmp(p->phase, "particles") != 0) {
        ck_assert_double_eq(p->share, 0);
        return 0;
    }
    course->calls++;
    ck_assert(p->share >= 0 && p->share <= 1);
    ck_assert_uint_ge(p->rays, course->rays);
    course->share = p->share;
    course->rays = p->rays;
    return 0;
}

START_TEST(test_particles_tell)
{
    RadDevice device = radNewDevice(NULL);
    RadScene scene = lamp_scene(device, 0.8);
    RadOracle oracle = default_oracle(device);
    RadSolution solution = radNewSolution(scene, oracle, NULL);
    struct course course = {0};
    radSetDeviceProgressFunction(device, follow, &course);
    ck_assert_int_eq(radSolve(solution), 0);
    ck_assert_int_eq(course.calls, 0);
    struct RadErrorReport report;
    const struct RadMeasureOptions how = {.rays = 400000};
    ck_assert_int_eq(radMeasureError(solution, &how, &report), 0);
    ck_assert_int_gt(course.calls, 10);
    ck_assert_double_gt(course.share, 0.5); /* the last told is before the end */
    ck_assert(fabs((double)course.rays - course.share * 400000) < 4000);
    course = (struct course){0};
    const struct RadCorrectOptions until = {.noise = 1e-6, .rays = 400000};
    ck_assert_int_eq(radCorrect(solution, &until, &report), 0);
    ck_assert_int_gt(course.calls, 10);
    ck_assert_double_gt(course.share, 0.5);
    ck_assert(fabs((double)course.rays - course.share * 400000) < 4000);
    radReleaseSolution(solution);
    radReleaseOracle(oracle);
    radReleaseScene(scene);
    radReleaseDevice(device);
}
END_TEST

static void expect_sums(const struct RadCausesReport *r)
{
    double power = 0, after = 0;
    for (int i = 0; i < RAD_CAUSES; i++) {
        power += r->cause[i].power.value;
        after += r->cause[i].after.value;
    }
    ck_assert_double_eq_tol(power, r->together.power.value, 1e-10);
    ck_assert_double_eq_tol(after, r->together.after.value, 1e-10);
    ck_assert(r->rays > 10000 && r->seconds > 0 && isfinite(power) && isfinite(after));
}

/* Causes are of links as they are, whether more passes would change them, by whichever solver and
 * closure, in three bands; mended or not, the same bits. */
START_TEST(test_causes)
{
    const struct RadMaterial materials[2] = {{{0.8, 0.3, 0.6}, {9, 7, 0}, 0},
                                             {{0.2, 0.9, 0.5}, {0, 0, 0}, 0}};
    const struct RadPolygons p = cube(lamp_above);
    const struct RadSolveOptions options[] = {{.closure = RAD_CLOSURE_ROWS},
                                              {.solver = RAD_SOLVER_SOUTHWELL},
                                              {.projection = RAD_PROJECTION_COLLOCATION}};
    const struct RadCausesOptions few = {.rays = 40000};
    struct RadCausesReport r, again;
    RadDevice device = radNewDevice(NULL);
    RadScene scene = make_scene(device, &p, materials, 2);
    RadOracle oracle = radNewOracle(device, "bf_guarded", RAD_RELEASE_FLAT);
    ck_assert_int_eq(radSetOracleParameter(oracle, "relative", 0.5), 0);
    for (size_t i = 0; i < sizeof options / sizeof *options; i++) {
        RadSolution solution = radNewSolution(scene, oracle, &options[i]);
        ck_assert_int_ge(radStep(solution), 0);
        ck_assert_int_eq(radFindCauses(solution, &few, &r), 0);
        expect_sums(&r);
        ck_assert_int_eq(radSolve(solution), 0);
        ck_assert_int_eq(radFindCauses(solution, &few, &r), 0);
        expect_sums(&r);
        struct RadErrorReport links;
        ck_assert_int_eq(radCorrect(solution, NULL, &links), 0);
        ck_assert_int_eq(radFindCauses(solution, &few, &again), 0);
        again.seconds = r.seconds;
        ck_assert_mem_eq(&again, &r, sizeof r);
        radReleaseSolution(solution);
    }
    radReleaseOracle(oracle);
    radReleaseScene(scene);
    radReleaseDevice(device);
}
END_TEST

static int stop_at_causes(void *user, const struct RadProgress *p)
{
    int stop = strcmp(p->phase, "causes") == 0;
    *(int *)user += stop;
    return stop;
}

/* Asked too early, of what it does not know, of too much; and cancelled. */
START_TEST(test_causes_refused)
{
    const struct RadCausesOptions many = {.rays = (uint64_t)1 << 33};
    const struct RadSolveOptions unit = {.unit = 1}, linear = {.basis = RAD_BASIS_LINEAR};
    struct RadCausesReport r;
    RadDevice device = radNewDevice(NULL);
    RadScene scene = lamp_scene(device, 0.5);
    RadOracle oracle = radNewOracle(device, "bf_guarded", RAD_RELEASE_FLAT);
    ck_assert_int_eq(radSetOracleParameter(oracle, "relative", 0.5), 0);
    RadSolution solution = radNewSolution(scene, oracle, NULL);
    ck_assert_int_eq(radFindCauses(solution, NULL, &r), -1);
    expect_error(device, RAD_ERROR_INVALID_OPERATION, "radSolve or radStep comes first");
    ck_assert_int_eq(radSolve(solution), 0);
    ck_assert_int_eq(radFindCauses(solution, &many, &r), -1);
    expect_error(device, RAD_ERROR_INVALID_ARGUMENT, "at most 2^32");
    int asked = 0;
    radSetDeviceProgressFunction(device, stop_at_causes, &asked);
    ck_assert_int_eq(radFindCauses(solution, NULL, &r), -1);
    ck_assert_int_eq(asked, 1); /* not asked again */
    expect_error(device, RAD_ERROR_CANCELLED, "cancelled by the progress function");
    radReleaseSolution(solution);
    solution = radNewSolution(scene, oracle, &linear);
    ck_assert_int_eq(radSolve(solution), 0);
    ck_assert_int_eq(radFindCauses(solution, NULL, &r), -1);
    expect_error(device, RAD_ERROR_INVALID_OPERATION, "RAD_BASIS_CONSTANT");
    radReleaseSolution(solution);
    solution = radNewSolution(scene, oracle, &unit);
    ck_assert_int_eq(radStep(solution), 0);
    ck_assert_int_eq(radFindCauses(solution, NULL, &r), -1);
    expect_error(device, RAD_ERROR_INVALID_OPERATION, "unit has none");
    ck_assert_int_eq(radFindCauses(NULL, NULL, &r), -1);
    radReleaseSolution(solution);
    radReleaseOracle(oracle);
    radReleaseScene(scene);
    radReleaseDevice(device);
}
END_TEST

/* The first error stays until it is asked for; the message function hears of all. */
static void count_messages(void *user, enum RadError code, const char *message)
{
    int *heard = user;
    ck_assert_int_eq(code, RAD_ERROR_INVALID_ARGUMENT);
    ck_assert_int_gt((int)strlen(message), 20);
    ++*heard;
}

START_TEST(test_first_error)
{
    RadDevice device = radNewDevice(&(struct RadDeviceOptions){.threads = 1});
    int heard = 0;
    radSetDeviceMessageFunction(device, count_messages, &heard);
    ck_assert_ptr_null(radNewOracle(device, "first", RAD_RELEASE_FLAT));
    ck_assert_ptr_null(radNewOracle(device, "second", RAD_RELEASE_FLAT));
    ck_assert_int_eq(heard, 2);
    expect_error(device, RAD_ERROR_INVALID_ARGUMENT, "'first'");
    radReleaseDevice(device);
}
END_TEST

/* ---- cancelling */

struct patience {
    int calls, most;
    const char *phase; /* only calls of this phase count; NULL: all */
};

static int lose_patience(void *user, const struct RadProgress *p)
{
    struct patience *patience = user;
    ck_assert_int_ge(p->pass, 1);
    if (patience->phase && strcmp(p->phase, patience->phase) != 0)
        return 0;
    return ++patience->calls >= patience->most;
}

static int stop_between(void *user, RadSolution solution)
{
    (void)solution;
    return ++*(int *)user;
}

START_TEST(test_cancel)
{
    RadDevice device = radNewDevice(NULL);
    RadScene scene = lamp_scene(device, 0.8);
    RadOracle oracle = default_oracle(device);
    struct patience patience = {0, 1 << 30, NULL};
    radSetDeviceProgressFunction(device, lose_patience, &patience);
    RadSolution whole = radNewSolution(scene, oracle, NULL);
    ck_assert_int_eq(radSolve(whole), 0);
    ck_assert_int_gt(patience.calls, 10);
    radReleaseSolution(whole);
    struct RadLinks links;
    double b[6];
    for (int last = patience.calls, most = 1; most <= last; most += 1 + most / 4) {
        RadSolution solution = radNewSolution(scene, oracle, NULL);
        patience = (struct patience){0, most, NULL};
        ck_assert_int_eq(radSolve(solution), -1);
        ck_assert_int_eq(patience.calls, most); /* not asked again */
        expect_error(device, RAD_ERROR_CANCELLED, "cancelled");
        ck_assert_int_eq(radStep(solution), -1);
        expect_error(device, RAD_ERROR_INVALID_OPERATION, "release it");
        ck_assert_int_eq(radGetPolygonValues(solution, 0, b, NULL), -1);
        radGetLinks(solution, &links);
        ck_assert_uint_eq(links.count, 0);
        radReleaseSolution(solution);
        expect_error(device, RAD_ERROR_INVALID_OPERATION, "release it");
    }
    RadSolution passing = radNewSolution(scene, oracle, NULL);
    int passes = 0;
    patience = (struct patience){0, 1 << 30, NULL};
    radSetSolutionPassFunction(passing, stop_between, &passes);
    ck_assert_int_eq(radSolve(passing), -1);
    ck_assert_int_eq(passes, 1);
    expect_error(device, RAD_ERROR_CANCELLED, "cancelled by the pass function");
    radReleaseSolution(passing);
    static const char *const phases[] = {"refine", "factors"};
    for (int i = 0; i < 2; i++) {
        patience = (struct patience){0, 1, phases[i]};
        ck_assert_ptr_null(radNewExchange(scene, NULL, NULL));
        ck_assert_int_eq(patience.calls, 1);
        expect_error(device, RAD_ERROR_CANCELLED, "cancelled");
    }
    for (int way = RAD_METHOD_PARTICLES; way <= RAD_METHOD_PATHS; way++) {
        RadReference reference = radNewReference(scene);
        patience = (struct patience){0, 1, way == RAD_METHOD_PATHS ? "paths" : "particles"};
        ck_assert_int_eq(radTraceReference(reference, (enum RadMethod)way, 1 << 22), -1);
        ck_assert_int_eq(patience.calls, 1);
        expect_error(device, RAD_ERROR_CANCELLED, "cancelled");
        ck_assert_int_eq(radTraceReference(reference, (enum RadMethod)way, 1), -1);
        expect_error(device, RAD_ERROR_INVALID_OPERATION, "release it");
        radReleaseReference(reference);
    }
    radReleaseOracle(oracle);
    radReleaseScene(scene);
    radReleaseDevice(device);
}
END_TEST

/* ---- threads and lifetimes */

struct job {
    RadDevice device;
    double rho, b[6];
};

static void *solve_job(void *argument)
{
    struct job *job = argument;
    RadScene scene = lamp_scene(job->device, job->rho);
    RadOracle oracle = radNewOracle(job->device, radGetDefaultOracle(), RAD_RELEASE_FLAT);
    RadSolution solution = radNewSolution(scene, oracle, NULL);
    ck_assert_int_eq(radSolve(solution), 0);
    ck_assert_int_eq(radGetPolygonValues(solution, 0, job->b, NULL), 0);
    radReleaseSolution(solution);
    radReleaseOracle(oracle);
    radReleaseScene(scene);
    return NULL;
}

START_TEST(test_side_by_side)
{
    enum { JOBS = 4 };
    RadDevice device = radNewDevice(&(struct RadDeviceOptions){.threads = 2});
    struct job alone[JOBS], together[JOBS], inside[JOBS];
    for (int i = 0; i < JOBS; i++) {
        alone[i] = together[i] = inside[i] =
            (struct job){.device = device, .rho = 0.3 + 0.2 * (i % 2)};
        solve_job(&alone[i]);
    }
    pthread_t thread[JOBS];
    for (int i = 0; i < JOBS; i++)
        ck_assert_int_eq(pthread_create(&thread[i], NULL, solve_job, &together[i]), 0);
    for (int i = 0; i < JOBS; i++)
        pthread_join(thread[i], NULL);
#pragma omp parallel for num_threads(JOBS) schedule(static, 1)
    for (int i = 0; i < JOBS; i++)
        solve_job(&inside[i]);
    for (int i = 0; i < JOBS; i++) {
        ck_assert_int_eq(memcmp(alone[i].b, together[i].b, sizeof alone[i].b), 0);
        ck_assert_int_eq(memcmp(alone[i].b, inside[i].b, sizeof alone[i].b), 0);
    }
    ck_assert_int_ne(memcmp(alone[0].b, alone[1].b, sizeof alone[0].b), 0);
    radReleaseDevice(device);
}
END_TEST

/* Two threads, two counting oracles, from threads of a caller's team that is larger than the
 * device's. */
START_TEST(test_count_side_by_side)
{
    enum { JOBS = 4 };
    RadDevice device = radNewDevice(&(struct RadDeviceOptions){.threads = 1});
    uint64_t calls[JOBS];
#pragma omp parallel for num_threads(JOBS) schedule(static, 1)
    for (int i = 0; i < JOBS; i++) {
        RadScene scene = lamp_scene(device, 0.5);
        RadOracle oracle = radNewOracle(device, "bf_guarded", RAD_RELEASE_DAG);
        ck_assert_int_eq(radCountOracle(oracle), 0);
        RadSolution solution = radNewSolution(scene, oracle, NULL);
        ck_assert_int_eq(radSolve(solution), 0);
        struct RadStatistics s;
        ck_assert_int_eq(radGetOracleStatistics(oracle, &s), 0);
        calls[i] = s.nodes[0].calls;
        radReleaseSolution(solution);
        radReleaseOracle(oracle);
        radReleaseScene(scene);
    }
    for (int i = 1; i < JOBS; i++)
        ck_assert_uint_eq(calls[i], calls[0]);
    radReleaseDevice(device);
}
END_TEST

/* What compares all links, or ranks them, keeps more than a state has. */
START_TEST(test_no_state)
{
    static const char *const oracles[] = {"bracket", "error_control", "ranked"};
    RadDevice device = radNewDevice(NULL);
    RadScene scene = lamp_scene(device, 0.5);
    for (size_t i = 0; i < sizeof oracles / sizeof *oracles; i++) {
        struct RadStatePart part[RAD_STATE_PARTS];
        RadOracle oracle = radNewOracle(device, oracles[i], RAD_RELEASE_FLAT);
        RadSolution solution = radNewSolution(scene, oracle, NULL);
        ck_assert_int_eq(radRefine(solution), 0);
        ck_assert_msg(radGetSolutionState(solution, part) == -1, "%s", oracles[i]);
        expect_error(device, RAD_ERROR_UNSUPPORTED, "checkpoints are not for oracles");
        radReleaseSolution(solution);
        radReleaseOracle(oracle);
    }
    radReleaseScene(scene);
    radReleaseDevice(device);
}
END_TEST

/* A state of the default's clusters is one of those that it has chosen. */
START_TEST(test_state_of_clusters)
{
    static const char *const taken[] = {NULL, "halves"}, *const refused[] = {"sah", "octree"};
    RadDevice device = radNewDevice(NULL);
    RadScene scene = lamp_scene(device, 0.5);
    RadOracle oracle = default_oracle(device);
    RadSolution from = radNewSolution(scene, oracle, NULL);
    struct RadStatePart part[RAD_STATE_PARTS];
    ck_assert_int_eq(radRefine(from), 0);
    ck_assert_msg(radGetSolutionState(from, part) == 0, "%s", radGetDeviceErrorMessage(device));
    for (int i = 0; i < 4; i++) {
        const struct RadSolveOptions options = {.clustering = i < 2 ? taken[i] : refused[i - 2]};
        RadSolution to = radNewSolution(scene, oracle, &options);
        ck_assert_int_eq(radSetSolutionState(to, part), i < 2 ? 0 : -1);
        if (i >= 2)
            expect_error(device, RAD_ERROR_INVALID_ARGUMENT, "it is of ");
        radReleaseSolution(to);
    }
    radReleaseSolution(from);
    radReleaseOracle(oracle);
    radReleaseScene(scene);
    radReleaseDevice(device);
}
END_TEST

/* Of one graph's releases each goes on from the other's state, to the same bits. */
START_TEST(test_state_of_releases)
{
    static const enum RadRelease release[] = {RAD_RELEASE_FLAT, RAD_RELEASE_DAG};
    RadDevice device = radNewDevice(NULL);
    RadScene scene = lamp_scene(device, 0.5);
    struct RadReport whole, then;
    for (int i = 0; i < 2; i++) {
        RadOracle first = radNewOracle(device, "bf_guarded", release[i]),
                  second = radNewOracle(device, "bf_guarded", release[!i]);
        RadSolution from = radNewSolution(scene, first, NULL),
                    to = radNewSolution(scene, second, NULL);
        struct RadStatePart part[RAD_STATE_PARTS];
        ck_assert_int_eq(radRefine(from), 0);
        ck_assert_int_eq(radGetSolutionState(from, part), 0);
        ck_assert_msg(radSetSolutionState(to, part) == 0, "%s", radGetDeviceErrorMessage(device));
        ck_assert_int_eq(radSolve(from), 0);
        ck_assert_int_eq(radSolve(to), 0);
        radGetReport(from, &whole);
        radGetReport(to, &then);
        ck_assert_uint_eq(whole.link_fingerprint, then.link_fingerprint);
        ck_assert(whole.absorbed == then.absorbed);
        radReleaseSolution(from);
        radReleaseSolution(to);
        radReleaseOracle(first);
        radReleaseOracle(second);
    }
    radReleaseScene(scene);
    radReleaseDevice(device);
}
END_TEST

/* Handles keep alive what they were made from, in whatever order they are given up. */
START_TEST(test_lifetimes)
{
    RadDevice device = radNewDevice(NULL);
    RadScene scene = lamp_scene(device, 0.5);
    RadOracle oracle = default_oracle(device);
    RadExchange exchange = radNewExchange(scene, NULL, NULL);
    radReleaseDevice(device);
    RadSolution solution = radNewSolution(scene, oracle, NULL);
    radReleaseOracle(oracle);
    radRetainSolution(solution);
    radReleaseSolution(solution);
    radReleaseScene(scene);
    double b[6], row[6];
    ck_assert_int_eq(radSolve(solution), 0);
    ck_assert_int_eq(radGetPolygonValues(solution, 0, b, NULL), 0);
    ck_assert_double_gt(b[0], 1);
    radReleaseSolution(solution);
    ck_assert_double_eq_tol(radGetExchangeRow(exchange, 0, row), 1, 3e-4);
    radReleaseExchange(exchange);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("api");
    TCase *t = tcase_create("api");
    tcase_set_timeout(t, 120);
    tcase_add_test(t, test_furnace);
    tcase_add_test(t, test_steps);
    tcase_add_test(t, test_views);
    tcase_add_test(t, test_linear);
    tcase_add_test(t, test_factors);
    tcase_add_test(t, test_measured_is_forgotten);
    tcase_add_test(t, test_polygons);
    tcase_add_test(t, test_exchange);
    tcase_add_test(t, test_reference);
    tcase_add_test(t, test_error_by_reference);
    tcase_add_test(t, test_oracles);
    tcase_add_test(t, test_plugins);
    tcase_add_test(t, test_children_ignored);
    tcase_add_test(t, test_registered);
    tcase_add_test(t, test_statistics);
    tcase_add_test(t, test_no_handle);
    tcase_add_test(t, test_no_place);
    tcase_add_test(t, test_bad_scenes);
    tcase_add_test(t, test_solvers);
    tcase_add_test(t, test_bad_options);
    tcase_add_test(t, test_first_error);
    tcase_add_test(t, test_cancel);
    tcase_add_test(t, test_particles_tell);
    tcase_add_test(t, test_causes);
    tcase_add_test(t, test_causes_refused);
    tcase_add_test(t, test_side_by_side);
    tcase_add_test(t, test_count_side_by_side);
    tcase_add_test(t, test_no_state);
    tcase_add_test(t, test_state_of_clusters);
    tcase_add_test(t, test_state_of_releases);
    tcase_add_test(t, test_lifetimes);
    suite_add_tcase(suite, t);
    return suite_failures(suite) != 0;
}
