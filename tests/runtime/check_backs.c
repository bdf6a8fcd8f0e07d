/* check_backs.c - light that ends on black backs: RadErrorReport.backs.
 *
 * In a unit cube whose ceiling emits and where nothing is reflected, all light ends where it first
 * lands: of a floor that is turned over F = .1998 (Howell's C-11), of a wall that is (1 - F) / 4.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include "radiosity.h"
#include "suite.h"

static const double corners[24] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0,
                                   0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1};
static const uint32_t sides[6][4] = {{4, 7, 6, 5}, {0, 1, 2, 3}, {0, 4, 5, 1},
                                     {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}};
static const double facing = 0.19982490;

/* Face i is turned over where bit i of `turned` is set. *absorbed: W by fronts, of one emitted in a
 * band. */
static struct RadErrorReport measure(unsigned turned, int two_sided, double rho, int bands,
                                     double *absorbed)
{
    uint32_t indices[6][4], materials[6] = {0, 1, 1, 1, 1, 1};
    const double red = bands == 3 ? 2 : 1;
    const struct RadMaterial material[2] = {{{rho, rho, rho}, {red, 1, 1}, 0},
                                            {{rho, rho, rho}, {0, 0, 0}, two_sided}};
    for (int i = 0; i < 6; i++)
        for (int k = 0; k < 4; k++)
            indices[i][k] = sides[i][turned >> i & 1 ? 3 - k : k];
    const struct RadPolygons polygons = {.positions = corners,
                                         .position_count = 8,
                                         .indices = indices[0],
                                         .size = 4,
                                         .materials = materials,
                                         .count = 6};
    RadDevice device = radNewDevice(NULL);
    RadScene scene = radNewScene(device);
    ck_assert_int_eq(radSetSceneMaterials(scene, material, 2), 0);
    ck_assert_int_eq(radSetSceneSharedPolygons(scene, &polygons), 0);
    ck_assert_msg(radCommitScene(scene) == 0, "%s", radGetDeviceErrorMessage(device));
    RadOracle oracle = radNewOracle(device, radGetDefaultOracle(), RAD_RELEASE_FLAT);
    RadSolution solution = radNewSolution(scene, oracle, NULL);
    const struct RadMeasureOptions how = {.rays = 1u << 17};
    struct RadErrorReport report;
    ck_assert_int_eq(radSolve(solution), 0);
    ck_assert_int_eq(radMeasureError(solution, &how, &report), 0);
    double irradiance[6];
    ck_assert_int_eq(radGetPolygonValues(solution, 0, NULL, irradiance), 0);
    *absorbed = 0;
    for (int i = 0; i < 6; i++)
        *absorbed += (1 - rho) * irradiance[i];
    radReleaseSolution(solution);
    radReleaseOracle(oracle);
    radReleaseScene(scene);
    radReleaseDevice(device);
    return report;
}

START_TEST(test_turned)
{
    double absorbed;
    for (int bands = 1; bands <= 3; bands += 2) {
        struct RadErrorReport r = measure(1u << 1, 0, 0, bands, &absorbed);
        ck_assert_double_eq_tol(r.backs, facing, 0.003);
        ck_assert_double_eq(r.back_share, 1);
        ck_assert_uint_eq(r.back, 1);
        r = measure(1u << 1 | 1u << 4, 0, 0, bands,
                    &absorbed); /* as much on either, but for 2e-4 */
        ck_assert_double_eq_tol(r.backs, facing + (1 - facing) / 4, 0.004);
        ck_assert_double_eq_tol(r.back_share, 0.5, 0.01);
        ck_assert(r.back == 1 || r.back == 4);
    }
}
END_TEST

/* Nothing is met from behind, or behind is a side like the other. */
START_TEST(test_none)
{
    double absorbed;
    const struct RadErrorReport r[2] = {measure(0, 0, 0.5, 1, &absorbed),
                                        measure(1u << 1, 1, 0.5, 1, &absorbed)};
    for (int i = 0; i < 2; i++) {
        ck_assert_double_eq(r[i].backs, 0);
        ck_assert_double_eq(r[i].back_share, 0);
        ck_assert_uint_eq(r[i].back, 6);
    }
}
END_TEST

/* Light that comes back from the other faces ends there in the end, or in them. */
START_TEST(test_reflected)
{
    double absorbed;
    const struct RadErrorReport r = measure(1u << 1, 0, 0.9, 1, &absorbed);
    ck_assert_double_gt(r.backs, 3 * facing);
    ck_assert_double_eq_tol(r.backs + absorbed, 1, 0.01);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("backs");
    TCase *t = tcase_create("backs");
    tcase_set_timeout(t, 60);
    tcase_add_test(t, test_turned);
    tcase_add_test(t, test_none);
    tcase_add_test(t, test_reflected);
    suite_add_tcase(suite, t);
    return suite_failures(suite) != 0;
}
