/* scene.h - what solutions are made over: flat convex faces with the materials of the polygons they
 * come from.
 * SPDX-License-Identifier: MIT */
#ifndef SCENE_H
#define SCENE_H

#include <stdint.h>
#include "hierarchy/hierarchy.h"
#include "radiosity.h"

struct scene {
    /* [face_count], by polygon: bent and concave polygons are several, cut ones too, two-sided
     * ones two (front, then `back`) */
    struct face *faces;
    uint32_t face_count;
    /* [face_count]: the same, which say what is dark (lit_faces.h); NULL: nobody asked, or nothing
     * is */
    struct face *lit;
    struct RadMaterial *materials;
    uint32_t material_count;
    /* [input_count]: one side's area of each polygon (m2), 0 of those that were dropped */
    double *areas;
    uint32_t input_count; /* polygons */
    /* relative rounding of coordinates: half a unit in the last place of what they have been; 0:
     * exact */
    double precision;
    uint32_t bands;   /* 1 when every material that is used is grey, else 3 */
    uint32_t dropped; /* polygons without area */
    /* polygons that cross themselves (crossing.h), and the first of them */
    uint32_t crossing, crossing_first;
    /* faces cut where others stand in them (cut_faces.h) or across (long_faces.h), far sides not
     * counted */
    uint32_t cut;
    uint32_t parts; /* into so many, which share their face's polygon */
    /* polygons that lay on others and have lost what was covered (overlaps.h); the first of them */
    uint32_t overlaps;
    double overlap_area; /* that they lost, of all their sides (m2) */
    struct RadOverlap overlap[RAD_OVERLAPS_NAMED];
    struct RadTurnedPolygons turned_closed, turned_open; /* shells.h */
};

/* What keeps a scene from being built. */
struct scene_error {
    enum RadError code;
    char text[256]; /* a sentence that names the polygon or the material, counted from 0 */
};

/* Make a scene of polygons and materials, which are borrowed for the call alone, on so many threads
 * (0: as many as there are processors). Polygons without area, or with fewer than three corners,
 * are dropped, and what others cover is taken off (overlaps.h); both are counted. Returns 0, or -1;
 * then *scene is empty and *error says why. */
int scene_build(struct scene *scene, const struct RadPolygons *polygons,
                const struct RadMaterial *materials, uint32_t material_count, int threads,
                struct scene_error *error);
void scene_free(struct scene *scene);

static inline int scene_is_pair(const struct scene *s, uint32_t front)
{
    return face_is_pair(s->faces, s->face_count, front);
}

#endif
