/* solution.h - what the writers of pictures, meshes and tables read: surfaces, and radiosity on
 * their elements.
 *
 * Both are views: whatever they were made of must outlive them. They are plain, so that a test may
 * make up its own.
 * SPDX-License-Identifier: MIT */
#ifndef SOLUTION_H
#define SOLUTION_H

#include "radiosity.h"

/* A scene: the faces that the library made of the polygons of the scene file, and those polygons
 * themselves. */
struct surfaces {
    const struct RadFace *faces; /* [face_count] */
    uint32_t face_count;
    const struct RadMaterial *materials;
    /* and the rest with it: for tables, whose rows are polygons */
    uint32_t polygon_count;
    const double *polygon_areas; /* m2, one side; 0 of those that were dropped */
    const uint32_t *polygon_materials;
    char *const *material_names;
};

/* Values are constant over a leaf, or linear (tree.gradient). Radiosity is the mean over what of an
 * element no solid stands on, irradiance the mean over all of it, what its ancestors receive
 * included. */
struct solution {
    struct surfaces surfaces;
    struct RadElements tree;
    int threads; /* that may draw it; 0 is 1 */
    int quiet;   /* 1: no warnings about files that are written of it */
};

/* Materials of polygons and names of materials are the scene file's, which the library does not
 * know; both may be NULL when no table is written. Empty before the commit. */
static inline struct surfaces surfaces_of(RadScene scene, const uint32_t *polygon_materials,
                                          char *const *material_names)
{
    struct RadSceneReport report;
    if (radGetSceneReport(scene, &report) < 0)
        return (struct surfaces){0};
    return (struct surfaces){radGetSceneFaces(scene),
                             report.faces,
                             radGetSceneMaterials(scene),
                             report.polygons,
                             radGetScenePolygonAreas(scene),
                             polygon_materials,
                             material_names};
}

static inline struct solution solution_of(const struct surfaces *surfaces, RadSolution solution,
                                          int threads)
{
    struct solution s = {.surfaces = *surfaces, .threads = threads};
    radGetElements(solution, &s.tree);
    return s;
}

/* A surface without parts. */
static inline int is_leaf(const struct element *e)
{
    return e->vertices && !e->children;
}

static inline const struct element *element_of_face(const struct solution *s, uint32_t face)
{
    return &s->tree.elements[s->tree.face_element[face]];
}

/* B per band, W/m2. */
static inline const double *radiosity_of(const struct solution *s, uint32_t element)
{
    return &s->tree.radiosity[(size_t)element * s->tree.bands];
}

/* B at a point of a leaf: what its basis says, and not below 0 by rounding. */
static inline double radiosity_at(const struct solution *s, uint32_t element, uint32_t band,
                                  const double point[3])
{
    size_t at = (size_t)element * s->tree.bands + band;
    double value = s->tree.radiosity[at];
    if (!s->tree.gradient)
        return value;
    for (int c = 0; c < 3; c++)
        value +=
            s->tree.gradient[3 * at + (size_t)c] * (point[c] - s->tree.elements[element].centre[c]);
    return value > 0 ? value : 0;
}

static inline int is_lamp(const struct surfaces *s, uint32_t face)
{
    const double *e = s->materials[s->faces[face].material].exitance;
    return e[0] > 0 || e[1] > 0 || e[2] > 0;
}

#endif
