/* make_pair.h - two elements in a scene of their own, and chance with a fixed seed, for tests.
 * SPDX-License-Identifier: MIT */
#ifndef MAKE_PAIR_H
#define MAKE_PAIR_H

#include <check.h>
#include <math.h>
#include "hierarchy/hierarchy.h"
#include "scene/make_scene.h"

struct two {
    struct scene scene;
    struct hierarchy h;
    const struct element *a, *b;
    struct host host;
};

/* The elements of the scene's first two faces; after a split they have moved. */
static inline void two_find(struct two *t)
{
    t->a = hierarchy_surface(&t->h, 0);
    t->b = hierarchy_surface(&t->h, 1);
}

static inline void two_open(struct two *t)
{
    ck_assert_int_eq(hierarchy_build(&t->h, t->scene.faces, t->scene.face_count), 0);
    memset(&t->host, 0, sizeof t->host);
    t->host.area = 1;
    t->host.mean_reflectance = 1;
    two_find(t);
}

static inline void two_close(struct two *t)
{
    hierarchy_free(&t->h);
    made_close(&t->scene);
}

/* Room for what stands between, too: thousands are opened. */
enum { TWO_FACES = 64 };

static inline void two_start(struct two *t)
{
    made_open_for(&t->scene, TWO_FACES);
    made_material(&t->scene, 0.5, 0);
}

/* Aligned rectangles a x b at distance c. */
static inline void two_parallel(struct two *t, double a, double b, double c)
{
    two_start(t);
    made_quad(&t->scene, 0, 0, 0, 0, a, 0, 0, 0, b, 0);
    made_quad(&t->scene, 0, 0, 0, c, 0, b, 0, a, 0, 0);
    two_open(t);
}

/* A floor l x w and a wall l x h that share the edge l. */
static inline void two_perpendicular(struct two *t, double w, double h, double l)
{
    two_start(t);
    made_quad(&t->scene, 0, 0, 0, 0, l, 0, 0, 0, w, 0);
    made_quad(&t->scene, 0, 0, 0, 0, 0, 0, h, l, 0, 0);
    two_open(t);
}

static inline struct discussion two_discussion(const struct two *t)
{
    struct discussion d;
    memset(&d, 0, sizeof d);
    d.receiver = t->a;
    d.emitter = t->b;
    d.host = &t->host;
    return d;
}

static inline double random_unit(unsigned *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (*state >> 8) / 16777216.0;
}

/* From 1 / span to span, evenly in the logarithm. */
static inline double random_size(unsigned *state, double span)
{
    return pow(span, 2 * random_unit(state) - 1);
}

/* Two random parallelograms, or triangles, `apart` from each other, that may cross each other's
 * planes; all times `scale`. */
static inline void two_random(struct two *t, int triangles, double apart, double scale,
                              unsigned *state)
{
    two_start(t);
    for (int i = 0; i < 2; i++) {
        double v[3][3], p[4][3];
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++)
                v[j][k] = (random_unit(state) - 0.5 + (j == 0 && k == 0 ? i * apart : 0)) * scale;
        for (int k = 0; k < 3; k++) {
            p[0][k] = v[0][k];
            p[1][k] = v[0][k] + v[1][k];
            p[2][k] = v[0][k] + (triangles ? 0 : v[1][k]) + v[2][k];
            p[3][k] = v[0][k] + v[2][k];
        }
        made_face(&t->scene, 0, triangles ? 3 : 4, (const double(*)[3])p);
    }
    two_open(t);
}

/* A random point of a triangle or parallelogram. */
static inline void random_point(const struct element *e, unsigned *state, double p[3])
{
    double s = random_unit(state), t = random_unit(state);
    int last = e->vertices - 1;
    if (e->vertices == 3 && s + t > 1) {
        s = 1 - s;
        t = 1 - t;
    }
    for (int k = 0; k < 3; k++)
        p[k] = e->vertex[0][k] + s * (e->vertex[1][k] - e->vertex[0][k])
               + t * (e->vertex[last][k] - e->vertex[0][k]);
}

#endif
