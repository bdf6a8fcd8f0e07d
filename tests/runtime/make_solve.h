/* make_solve.h - solves with an oracle by its name, and scenes that more than one suite solves.
 * SPDX-License-Identifier: MIT */
#ifndef MAKE_SOLVE_H
#define MAKE_SOLVE_H

#include <check.h>
#include <math.h>
#include <string.h>
#include "scene/make_scene.h"
#include "util/oracles.h"
#include "engine/solve.h"

static inline struct solve_options quick(int threads)
{
    struct solve_options o = {.tolerance = 1e-6, .iterations = 100000, .threads = threads};
    return o;
}

static inline struct solve_options quick_linear(int threads)
{
    struct solve_options o = quick(threads);
    o.linear = 1;
    return o;
}

/* Solve with an oracle; settings end with NULL. */
static inline void solve_with(struct solve *s, const struct scene *scene, const char *oracle,
                              enum release release, char *const *settings,
                              struct solve_options options)
{
    struct refiner *r = oracles_open(oracle, release);
    int n = 0;
    ck_assert_ptr_nonnull(r);
    while (settings && settings[n])
        n++;
    ck_assert_int_eq(oracles_set(r, settings, n), 0);
    const char *cause;
    ck_assert_int_eq(solve_open(s, scene, &options, &cause), 0);
    ck_assert_int_eq(solve_run(s, r, &cause), 0);
    ck_assert_int_eq(s->report.converged, 1);
    refiner_close(r);
}

static inline double face_radiosity(const struct solve *s, uint32_t face)
{
    return s->state.radiosity[(size_t)s->hierarchy.face_element[face] * s->problem.bands];
}

static inline void same_links(const struct solve *a, const struct solve *b)
{
    ck_assert_uint_eq(a->refinement.link_count, b->refinement.link_count);
    ck_assert_uint_eq(a->hierarchy.count, b->hierarchy.count);
    ck_assert(memcmp(a->refinement.links, b->refinement.links,
                     a->refinement.link_count * sizeof(struct link))
              == 0);
}

/* Six faces, rho and E the same everywhere. */
static inline void furnace_cube(struct scene *s, double rho)
{
    made_open(s);
    uint32_t m[6];
    m[0] = made_material(s, rho, 1);
    for (int i = 1; i < 6; i++)
        m[i] = m[0];
    made_room(s, m, 1, 1, 1);
}

/* A hexagonal prism: two fans of triangles and six quads. */
static inline void furnace_prism(struct scene *s, double rho)
{
    made_open(s);
    made_material(s, rho, 1);
    for (int i = 0; i < 6; i++) {
        double a = M_PI / 3 * i, b = M_PI / 3 * (i + 1), h = 0.8;
        const double low[3][3] = {{0, 0, 0}, {cos(a), sin(a), 0}, {cos(b), sin(b), 0}};
        const double high[3][3] = {{0, 0, h}, {cos(b), sin(b), h}, {cos(a), sin(a), h}};
        const double wall[4][3] = {
            {cos(b), sin(b), 0}, {cos(a), sin(a), 0}, {cos(a), sin(a), h}, {cos(b), sin(b), h}};
        made_face(s, 0, 3, low);
        made_face(s, 0, 3, high);
        made_face(s, 0, 4, wall);
    }
}

/* A regular octahedron from inside. */
static inline void furnace_octahedron(struct scene *s, double rho)
{
    made_open(s);
    made_material(s, rho, 1);
    for (int i = 0; i < 8; i++) {
        double x = i & 1 ? 1 : -1, y = i & 2 ? 1 : -1, z = i & 4 ? 1 : -1;
        const double out[3][3] = {{x, 0, 0}, {0, y, 0}, {0, 0, z}};
        const double in[3][3] = {{0, y, 0}, {x, 0, 0}, {0, 0, z}};
        made_face(s, 0, 3, x * y * z > 0 ? in : out);
    }
}

/* A room with a box on the floor and a lamp: something to compare with itself. `bright` scales
 * E. */
static inline void furnished(struct scene *s, double bright)
{
    uint32_t m[6];
    made_open(s);
    uint32_t grey = made_material(s, 0.6, 0);
    for (uint32_t i = 0; i < 6; i++)
        m[i] = grey;
    made_room(s, m, 4, 5, 3);
    made_material(s, 0.2, 10 * bright);
    made_material(s, 0.3, 0);
    made_quad(s, 1, 1, 2, 2.5, 0, 1, 0, 1, 0, 0);   /* a lamp that shines down */
    made_quad(s, 1, 1, 2, 2.5, 1, 0, 0, 0, 1, 0);   /* and up */
    made_quad(s, 2, 1.3, 1, 1, 1, 0, 0, 0, 1.5, 0); /* a box: top and sides */
    made_quad(s, 2, 1.3, 1, 0, 1, 0, 0, 0, 0, 1);
    made_quad(s, 2, 1.3, 2.5, 0, 0, 0, 1, 1, 0, 0);
    made_quad(s, 2, 1.3, 1, 0, 0, 0, 1, 0, 1.5, 0);
    made_quad(s, 2, 2.3, 1, 0, 0, 1.5, 0, 0, 0, 1);
}

/* What its walls emit themselves (W/m2), by loops: they are mended like walls that do not. */
static const double furnished_glows[] = {0, 0.01};
enum { FURNISHED_GLOWS = sizeof furnished_glows / sizeof *furnished_glows };

/* It, solved with slopes; settings as of solve_with. */
static inline void furnished_linear(struct solve *s, struct scene *scene, char *const *settings,
                                    double glow, int threads)
{
    furnished(scene, 1);
    for (int k = 0; k < 3; k++)
        scene->materials[0].exitance[k] = glow;
    solve_with(s, scene, "bf", RELEASE_FLAT, settings, quick_linear(threads));
}

#endif
