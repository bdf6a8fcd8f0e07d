/* make_scene.h - small scenes made in memory.
 * SPDX-License-Identifier: MIT */
#ifndef MAKE_SCENE_H
#define MAKE_SCENE_H

#include <stdlib.h>
#include <string.h>
#include "hierarchy/scene.h"

enum { MADE_FACES = 32768, MADE_MATERIALS = 16 };

/* An empty scene with room for so many faces. Returns 0, or -1 when out of memory. */
static inline int made_open_for(struct scene *s, size_t faces)
{
    memset(s, 0, sizeof *s);
    s->faces = calloc(faces, sizeof *s->faces);
    s->materials = calloc(MADE_MATERIALS, sizeof *s->materials);
    s->areas = calloc(faces, sizeof *s->areas);
    s->bands = 1;
    return s->faces && s->materials && s->areas ? 0 : -1;
}

static inline int made_open(struct scene *s)
{
    return made_open_for(s, MADE_FACES);
}

/* A grey material. Returns its index. */
static inline uint32_t made_material(struct scene *s, double rho, double exitance)
{
    struct RadMaterial *m = &s->materials[s->material_count];
    for (int k = 0; k < 3; k++) {
        m->reflectance[k] = rho;
        m->exitance[k] = exitance;
    }
    return s->material_count++;
}

/* A face with n corners p, counter-clockwise from its front. */
static inline void made_face(struct scene *s, uint32_t material, int n, const double (*p)[3])
{
    struct face *f = &s->faces[s->face_count];
    memcpy(f->vertex, p, (size_t)n * sizeof *p);
    f->vertices = (uint32_t)n;
    f->material = material;
    f->input = s->face_count;
    f->black =
        s->materials[material].reflectance[0] <= 0 && s->materials[material].exitance[0] <= 0;
    s->face_count++;
    s->input_count++;
}

/* A parallelogram o, o + a, o + a + b, o + b: its front is where a x b points. */
static inline void made_quad(struct scene *s, uint32_t material, double ox, double oy, double oz,
                             double ax, double ay, double az, double bx, double by, double bz)
{
    const double p[4][3] = {{ox, oy, oz},
                            {ox + ax, oy + ay, oz + az},
                            {ox + ax + bx, oy + ay + by, oz + az + bz},
                            {ox + bx, oy + by, oz + bz}};
    made_face(s, material, 4, p);
}

/* A box seen from inside: floor, ceiling, then the four walls. */
static inline void made_room(struct scene *s, const uint32_t material[6], double x, double y,
                             double z)
{
    made_quad(s, material[0], 0, 0, 0, x, 0, 0, 0, y, 0);
    made_quad(s, material[1], 0, 0, z, 0, y, 0, x, 0, 0);
    made_quad(s, material[2], 0, 0, 0, 0, 0, z, x, 0, 0);
    made_quad(s, material[3], 0, y, 0, x, 0, 0, 0, 0, z);
    made_quad(s, material[4], 0, 0, 0, 0, y, 0, 0, 0, z);
    made_quad(s, material[5], x, 0, 0, 0, 0, z, 0, y, 0);
}

/* A box along u, v and w from a corner, its front outside; without its first `missing` faces. */
static inline void made_box(struct scene *s, uint32_t material, const double at[3],
                            const double (*along)[3], int missing)
{
    static const int corners[6][4] = {{4, 5, 7, 6}, {0, 2, 3, 1}, {0, 4, 6, 2},
                                      {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}};
    for (int f = missing; f < 6; f++) {
        double p[4][3];
        for (int i = 0; i < 4; i++)
            for (int k = 0; k < 3; k++) {
                p[i][k] = at[k];
                for (int axis = 0; axis < 3; axis++)
                    p[i][k] += corners[f][i] >> axis & 1 ? along[axis][k] : 0;
            }
        made_face(s, material, 4, (const double(*)[3])p);
    }
}

/* Tile i of tiles x tiles on one of six faces of a unit cube with its least corner at `corner`:
 * face 2 k is across axis k there, 2 k + 1 on the far side. inside: 1: it is seen from inside. */
static inline void made_tile(struct scene *s, uint32_t material, double corner, int face, int i,
                             int tiles, int inside)
{
    const int k = face / 2, far = face % 2, u = (k + 1) % 3, v = (k + 2) % 3,
              turned = far == inside;
    const double side = 1. / tiles;
    double o[3], a[3] = {0, 0, 0}, b[3] = {0, 0, 0};
    o[k] = corner + far;
    o[u] = corner + i % tiles * side;
    o[v] = corner + i / tiles * side;
    a[turned ? v : u] = side;
    b[turned ? u : v] = side;
    made_quad(s, material, o[0], o[1], o[2], a[0], a[1], a[2], b[0], b[1], b[2]);
}

static inline void made_scale(struct scene *s, double factor)
{
    for (uint32_t i = 0; i < s->face_count; i++)
        for (uint32_t j = 0; j < s->faces[i].vertices; j++)
            for (int k = 0; k < 3; k++)
                s->faces[i].vertex[j][k] *= factor;
}

static inline void made_close(struct scene *s)
{
    free(s->faces);
    free(s->materials);
    free(s->areas);
}

#endif
