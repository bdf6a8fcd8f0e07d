/* engine.c - a program that computes light with libradiosity: engine RHO solves the unit cube,
 * whose ceiling emits 1 W/m2 and whose six faces reflect RHO, and prints the mean radiosity of each
 * face, the ceiling first. C11 and C++11 alike.
 * SPDX-License-Identifier: MIT */
#include <radiosity.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double corners[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                     {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
/* Counter-clockwise as seen from inside: ceiling, floor, walls. */
static const uint32_t faces[6][4] = {{4, 7, 6, 5}, {0, 1, 2, 3}, {0, 4, 5, 1},
                                     {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}};
static const uint32_t materials[6] = {0, 1, 1, 1, 1, 1}; /* the ceiling has material 0 */

/* Both materials reflect rho, one emits. */
static RadScene make_cube(RadDevice device, double rho)
{
    struct RadMaterial material[2] = {{{rho, rho, rho}, {1, 1, 1}, 0},
                                      {{rho, rho, rho}, {0, 0, 0}, 0}};
    struct RadPolygons cube;
    memset(&cube, 0, sizeof cube);
    cube.positions = &corners[0][0];
    cube.position_count = 8;
    cube.indices = &faces[0][0];
    cube.size = 4;
    cube.materials = materials;
    cube.count = 6;
    RadScene scene = radNewScene(device);
    if (radSetSceneMaterials(scene, material, 2) < 0 || radSetSceneSharedPolygons(scene, &cube) < 0
        || radCommitScene(scene) < 0) {
        radReleaseScene(scene);
        return NULL;
    }
    return scene;
}

int main(int argc, char **argv)
{
    char *end = NULL;
    double rho = argc == 2 ? strtod(argv[1], &end) : 0, radiosity[6];
    if (argc != 2 || end == argv[1] || *end) {
        fprintf(stderr,
                "usage: engine RHO, the reflectance of the cube's faces, 0 or more and below 1\n");
        return 2;
    }
    RadDevice device = radNewDevice(NULL);
    RadScene scene = make_cube(device, rho);
    RadOracle oracle = radNewOracle(device, radGetDefaultOracle(), RAD_RELEASE_FLAT);
    RadSolution solution = radNewSolution(scene, oracle, NULL);
    int failed = radSolve(solution) < 0 || radGetPolygonValues(solution, 0, radiosity, NULL) < 0;
    if (failed)
        fprintf(stderr, "engine: %s\n", radGetDeviceErrorMessage(device));
    for (int i = 0; i < 6 && !failed; i++)
        printf("%.7f\n", radiosity[i]);
    failed = failed ? radGetDeviceError(device) == RAD_ERROR_INVALID_SCENE ? 2 : 1 : 0;
    radReleaseSolution(solution);
    radReleaseOracle(oracle);
    radReleaseScene(scene);
    radReleaseDevice(device);
    return failed;
}
