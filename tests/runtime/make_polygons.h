/* make_polygons.h - scenes of polygons that a test puts together, and their view factors.
 * SPDX-License-Identifier: MIT */
#ifndef MAKE_POLYGONS_H
#define MAKE_POLYGONS_H

#include <check.h>
#include <stdint.h>
#include <string.h>

#include "radiosity.h"

enum { POSITIONS = 4096, INDICES = 8192, FACES = 512 };

static struct {
    double positions[3 * POSITIONS];
    uint32_t indices[INDICES], sizes[FACES], materials[FACES];
    uint32_t positions_used, indices_used, faces;
} scene;

static inline void clear(void)
{
    scene.positions_used = scene.indices_used = scene.faces = 0;
}

static inline void corner(double x, double y, double z)
{
    const double p[3] = {x, y, z};
    ck_assert_uint_lt(scene.positions_used, POSITIONS);
    memcpy(&scene.positions[3 * scene.positions_used], p, sizeof p);
    scene.indices[scene.indices_used++] = scene.positions_used++;
}

static inline void end_face(uint32_t corners)
{
    ck_assert_uint_lt(scene.faces, FACES);
    scene.sizes[scene.faces++] = corners;
}

static inline void polygon(const double (*v)[3], uint32_t corners)
{
    for (uint32_t i = 0; i < corners; i++)
        corner(v[i][0], v[i][1], v[i][2]);
    end_face(corners);
}

/* From a corner along two edges; the front is to their vector product. */
static inline void rectangle(const double at[3], const double u[3], const double v[3])
{
    corner(at[0], at[1], at[2]);
    corner(at[0] + u[0], at[1] + u[1], at[2] + u[2]);
    corner(at[0] + u[0] + v[0], at[1] + u[1] + v[1], at[2] + u[2] + v[2]);
    corner(at[0] + v[0], at[1] + v[1], at[2] + v[2]);
    end_face(4);
}

/* The polygons put together so far, grey, committed. */
static inline RadScene scene_on(RadDevice device)
{
    const struct RadMaterial grey = {.reflectance = {.5, .5, .5}};
    const struct RadPolygons polygons = {.positions = scene.positions,
                                         .position_count = scene.positions_used,
                                         .indices = scene.indices,
                                         .sizes = scene.sizes,
                                         .materials = scene.materials,
                                         .count = scene.faces};
    RadScene s = radNewScene(device);
    ck_assert_int_eq(radSetSceneMaterials(s, &grey, 1), 0);
    ck_assert_int_eq(radSetSceneSharedPolygons(s, &polygons), 0);
    ck_assert_msg(radCommitScene(s) == 0, "%s", radGetDeviceErrorMessage(device));
    return s;
}

/* Of a matrix of all faces. */
static inline double row_sum(const double *f, uint32_t row)
{
    double sum = 0;
    for (uint32_t i = 0; i < scene.faces; i++)
        sum += f[(size_t)row * scene.faces + i];
    return sum;
}

/* The first rows of the matrix, [rows][scene.faces], and all areas. */
static inline void factors(uint32_t rows, double tolerance, double *f, double *areas)
{
    const struct RadExchangeOptions how = {.tolerance = tolerance};
    RadDevice device = radNewDevice(&(struct RadDeviceOptions){.threads = 1});
    RadScene s = scene_on(device);
    RadExchange exchange = radNewExchange(s, NULL, &how);
    ck_assert_msg(exchange != NULL, "%s", radGetDeviceErrorMessage(device));
    memcpy(areas, radGetScenePolygonAreas(s), scene.faces * sizeof *areas);
    for (uint32_t i = 0; i < rows; i++)
        ck_assert_double_ge(radGetExchangeRow(exchange, i, &f[(size_t)i * scene.faces]), 0);
    radReleaseExchange(exchange);
    radReleaseScene(s);
    radReleaseDevice(device);
}

#endif
