/* made_scene.h - small scenes made in memory, as the arrays that radSetSceneSharedPolygons takes.
 * SPDX-License-Identifier: MIT */
#ifndef MADE_SCENE_H
#define MADE_SCENE_H

#include "kernel/surface.h"
#include "radiosity.h"

enum { MADE_POLYGONS = 1024, MADE_CORNERS = 4 * MADE_POLYGONS, MADE_MATERIALS = 8 };

/* All zero: empty. The cases keep below the bounds. */
struct made_scene {
    double position[MADE_CORNERS][3]; /* m; polygons share none */
    uint32_t index[MADE_CORNERS];
    uint32_t corners;
    uint32_t size[MADE_POLYGONS], material[MADE_POLYGONS];
    uint32_t count;
    struct RadMaterial materials[MADE_MATERIALS];
    uint32_t material_count;
    int as_given; /* its polygons are taken for flat, and not cut where others stand in them */
};

/* A grey material. Returns its index. */
static inline uint32_t made_material(struct made_scene *s, double rho, double exitance)
{
    s->materials[s->material_count] =
        (struct RadMaterial){{rho, rho, rho}, {exitance, exitance, exitance}, 0};
    return s->material_count++;
}

/* A polygon with n corners p, counter-clockwise from its front. */
static inline void made_face(struct made_scene *s, uint32_t material, uint32_t n,
                             const double (*p)[3])
{
    memcpy(s->position[s->corners], p, n * sizeof *p);
    for (uint32_t i = 0; i < n; i++, s->corners++)
        s->index[s->corners] = s->corners;
    s->size[s->count] = n;
    s->material[s->count++] = material;
}

/* A parallelogram o, o + a, o + a + b, o + b: its front is where a x b points. */
static inline void made_quad(struct made_scene *s, uint32_t material, double ox, double oy,
                             double oz, double ax, double ay, double az, double bx, double by,
                             double bz)
{
    const double p[4][3] = {{ox, oy, oz},
                            {ox + ax, oy + ay, oz + az},
                            {ox + ax + bx, oy + ay + by, oz + az + bz},
                            {ox + bx, oy + by, oz + bz}};
    made_face(s, material, 4, p);
}

/* A box seen from inside: floor, ceiling, then the four walls. */
static inline void made_room(struct made_scene *s, const uint32_t material[6], double x, double y,
                             double z)
{
    made_quad(s, material[0], 0, 0, 0, x, 0, 0, 0, y, 0);
    made_quad(s, material[1], 0, 0, z, 0, y, 0, x, 0, 0);
    made_quad(s, material[2], 0, 0, 0, 0, 0, z, x, 0, 0);
    made_quad(s, material[3], 0, y, 0, x, 0, 0, 0, 0, z);
    made_quad(s, material[4], 0, 0, 0, 0, y, 0, 0, 0, z);
    made_quad(s, material[5], x, 0, 0, 0, 0, z, 0, y, 0);
}

static inline void made_scale(struct made_scene *s, double factor)
{
    for (uint32_t i = 0; i < s->corners; i++)
        for (int k = 0; k < 3; k++)
            s->position[i][k] *= factor;
}

static inline void made_move(struct made_scene *s, double by)
{
    for (uint32_t i = 0; i < s->corners; i++)
        for (int k = 0; k < 3; k++)
            s->position[i][k] += by;
}

/* For the engine. Returns NULL after a message that names `where`. */
RadScene made_commit(const struct made_scene *made, RadDevice device, const char *where);

/* Polygon i as an element by itself, in no tree. */
static inline struct element made_element(const struct made_scene *s, uint32_t i)
{
    struct element e = {.vertices = (uint8_t)s->size[i], .face = i};
    uint32_t first = 0;
    for (uint32_t j = 0; j < i; j++)
        first += s->size[j];
    memcpy(e.vertex, s->position[first], s->size[i] * sizeof *e.vertex);
    surface_measure(&e);
    return e;
}

#endif
