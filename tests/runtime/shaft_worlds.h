/* shaft_worlds.h - scenes in which shafts are tried, made at random or read, with their elements
 * and rays.
 * SPDX-License-Identifier: MIT */
#ifndef SHAFT_WORLDS_H
#define SHAFT_WORLDS_H

#include <check.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "scene/make_scene.h"
#include "scene/read_scene.h"
#include "suite.h"
#include "visibility/rays.h"

static inline double random_unit(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) * (1 / 9007199254740992.0);
}

static inline double between(uint64_t *seed, double low, double high)
{
    return low + (high - low) * random_unit(seed);
}

/* ---- scenes */

enum { KINDS = 11, LOADED = 8 };
static const char *const kinds[KINDS] = {
    "room with boxes", "rotated room", "quads",   "triangles", "tiles", "wedges",
    "bent quads",      "far room",     "cornell", "maze_8",    "room"};

/* A closed box that stands on z, front outside. */
static inline void add_box(struct scene *s, double x, double y, double z, double a, double b,
                           double c)
{
    made_quad(s, 0, x, y, z, 0, b, 0, a, 0, 0);
    made_quad(s, 0, x, y, z + c, a, 0, 0, 0, b, 0);
    made_quad(s, 0, x, y, z, a, 0, 0, 0, 0, c);
    made_quad(s, 0, x, y + b, z, 0, 0, c, a, 0, 0);
    made_quad(s, 0, x, y, z, 0, 0, c, 0, b, 0);
    made_quad(s, 0, x + a, y, z, 0, b, 0, 0, 0, c);
}

static inline void rotate(struct scene *s, uint64_t *seed)
{
    double turn[3];
    for (int k = 0; k < 3; k++)
        turn[k] = between(seed, 0, 6);
    for (int k = 0; k < 3; k++)
        for (uint32_t i = 0; i < s->face_count; i++)
            for (uint32_t j = 0; j < s->faces[i].vertices; j++) {
                double *v = s->faces[i].vertex[j], a = v[k], b = v[(k + 1) % 3];
                v[k] = cos(turn[k]) * a - sin(turn[k]) * b;
                v[(k + 1) % 3] = sin(turn[k]) * a + cos(turn[k]) * b;
            }
}

static inline void make(struct scene *s, int kind, uint64_t *seed)
{
    static const uint32_t wall[6] = {0, 0, 0, 0, 0, 0};
    made_open(s);
    made_material(s, 0.5, 1);
    int i, k;
    switch (kind) {
    case 0:
    case 1:
    case 7:
        made_room(s, wall, 4, 5, 3);
        for (i = 0; i < 5; i++) {
            /* One at a time: compilers differ in which argument of a call is computed first. */
            double c = between(seed, 0.1, 1), b = between(seed, 0.1, 1), a = between(seed, 0.1, 1);
            double z = i < 3 ? 0 : between(seed, 0, 2);
            double y = between(seed, 0, 4), x = between(seed, 0, 3);
            add_box(s, x, y, z, a, b, c);
        }
        add_box(s, 0, 0, 0, 0.5, 1, 1); /* flush with two walls and the floor */
        if (kind > 0)
            rotate(s, seed);
        for (i = 0; i < (int)s->face_count && kind == 7; i++)
            for (k = 0; k < 4; k++)
                s->faces[i].vertex[k][0] += 3000; /* a thousand times its size from the origin */
        break;
    case 6: /* as bent as a quad may be that is read in one piece */
        for (i = 0; i < 40; i++) {
            double v[9], p[4][3];
            for (k = 0; k < 9; k++)
                v[k] = k < 3 ? random_unit(seed) : 0.6 * (random_unit(seed) - 0.5);
            for (k = 0; k < 3; k++) {
                p[0][k] = v[k];
                p[1][k] = v[k] + v[3 + k];
                p[3][k] = v[k] + v[6 + k];
                p[2][k] = v[k] + v[3 + k] + v[6 + k] + 5e-5 * (random_unit(seed) - 0.5);
            }
            made_face(s, 0, 4, (const double(*)[3])p);
        }
        break;
    case 2:
        for (i = 0; i < 60; i++) {
            double v[9];
            for (k = 0; k < 9; k++)
                v[k] = k < 3 ? random_unit(seed) : 0.5 * (random_unit(seed) - 0.5);
            if (i % 4 == 0)
                v[2] = 0.25, v[5] = v[8] = 0; /* in the plane z = 1/4 */
            made_quad(s, 0, v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7], v[8]);
        }
        break;
    case 3:
        for (i = 0; i < 60; i++) {
            double p[3][3];
            for (k = 0; k < 9; k++)
                p[k / 3][k % 3] =
                    k < 3 ? random_unit(seed) : p[0][k % 3] + 0.6 * (random_unit(seed) - 0.5);
            made_face(s, 0, 3, (const double(*)[3])p);
        }
        break;
    /* a tiled box: neighbours in one plane, T-junctions, and walls that stand on the lines
     * between tiles */
    case 4:
        for (i = 0; i < 16; i++) {
            made_quad(s, 0, i % 4, i / 4, 0, 1, 0, 0, 0, 1, 0);
            made_quad(s, 0, i % 4, i / 4, 4, 0, 1, 0, 1, 0, 0);
            made_quad(s, 0, i % 4, 0, i / 4, 0, 0, 1, 1, 0, 0);
            made_quad(s, 0, i % 4, 4, i / 4, 1, 0, 0, 0, 0, 1);
        }
        made_quad(s, 0, 0, 0, 0, 0, 4, 0, 0, 0, 4);
        made_quad(s, 0, 4, 0, 0, 0, 0, 4, 0, 4, 0);
        /* a wall without thickness, both its sides listed */
        made_quad(s, 0, 1, 2, 0, 2, 0, 0, 0, 0, 2);
        made_quad(s, 0, 1, 2, 0, 0, 0, 2, 2, 0, 0);
        s->faces[s->face_count - 1].back = 1;
        s->faces[s->face_count - 1].input = s->faces[s->face_count - 2].input;
        break;
    /* pairs that meet at an edge, at angles down to 6 degrees, and faces that touch their ends */
    default:
        for (i = 0; i < 20; i++) {
            double x = 2 * i, angle = between(seed, 0.1, 3.0);
            made_quad(s, 0, x, 0, 0, 1, 0, 0, 0, 1, 0);
            made_quad(s, 0, x, 0, 0, 0, cos(angle), sin(angle), 1, 0, 0);
            made_quad(s, 0, x, 1, 0, 1, 0, 0, 0, 0, between(seed, -1, 1));
            made_quad(s, 0, x + 1, 0, 0, 0, 1, 0, 0, 0, 1);
            made_quad(s, 0, x, 0, 2, 0, 1, 0, between(seed, 0.5, 1), 0, 0);
        }
        rotate(s, seed);
        break;
    }
}

struct world {
    struct scene scene;
    struct hierarchy h;
    struct rays *rays;
    const struct host *host;
    int loaded;
};

static inline void start_world(struct world *w, int threads)
{
    double *zero = calloc(w->scene.face_count, sizeof *zero);
    ck_assert_int_eq(hierarchy_build(&w->h, w->scene.faces, w->scene.face_count), 0);
    const char *cause;
    w->rays = rays_open(&w->h, zero, zero, threads, &cause);
    ck_assert_ptr_nonnull(w->rays);
    w->host = rays_host(w->rays);
    free(zero);
}

static inline void open_world(struct world *w, int kind, uint64_t *seed, double scale)
{
    memset(w, 0, sizeof *w);
    if (kind < LOADED) {
        make(&w->scene, kind, seed);
    } else {
        struct scene_options quiet = {.quiet = 1};
        char path[64];
        snprintf(path, sizeof path, "examples/scenes/%s.obj", kinds[kind]);
        ck_assert_int_eq(scene_read(&w->scene, path, &quiet), 0);
        w->loaded = 1;
    }
    made_scale(&w->scene, scale);
    start_world(w, 2);
}

static inline void close_world(struct world *w)
{
    rays_close(w->rays);
    hierarchy_free(&w->h);
    if (w->loaded)
        scene_free(&w->scene);
    else
        made_close(&w->scene);
}

/* A random child, made when there is none. */
static inline uint32_t descend(struct world *w, uint32_t e, uint64_t *seed)
{
    ck_assert_int_eq(hierarchy_split(&w->h, e), 0);
    return w->h.elements[e].child + (uint32_t)(4 * random_unit(seed));
}

static inline void random_pair(struct world *w, uint64_t *seed, int deepest, uint32_t pair[2])
{
    for (int i = 0; i < 2; i++) {
        pair[i] = w->h.face_element[(uint32_t)(random_unit(seed) * w->h.face_count)];
        for (int n = (int)(random_unit(seed) * (deepest + 1)); n > 0; n--)
            pair[i] = descend(w, pair[i], seed);
    }
}

/* Does the segment cross a triangle? In double precision; `slack` (m) beyond the border is in. */
static inline int crosses_triangle(const struct segment *g, const double *a, const double *b,
                                   const double *c, double slack, double thin)
{
    const double *v[3] = {a, b, c};
    double e[3], f[3], n[3], p[3];
    sub3(e, b, a);
    sub3(f, c, a);
    cross3(n, e, f);
    double size = length3(n);
    for (int k = 0; k < 3; k++)
        n[k] /= size;
    double from = height3(g->from, a, n);
    double to = height3(g->to, a, n);
    if (!(from > thin && to < -thin) && !(from < -thin && to > thin))
        return 0;
    for (int k = 0; k < 3; k++)
        p[k] = g->from[k] + from / (from - to) * (g->to[k] - g->from[k]);
    for (int i = 0; i < 3; i++) {
        sub3(e, v[(i + 1) % 3], v[i]);
        double side[3];
        cross3(side, n, e);
        if (height3(p, v[i], side) < -slack * length3(side))
            return 0;
    }
    return 1;
}

#endif
