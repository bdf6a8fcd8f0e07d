/* build_scene.h - polygons of any number of corners become the flat convex faces of a scene.
 * SPDX-License-Identifier: MIT */
#ifndef BUILD_SCENE_H
#define BUILD_SCENE_H

#include "hierarchy/scene.h"

/* Zero but for the scene, which has its materials and nothing else. */
struct scene_builder {
    struct scene *scene;
    uint32_t face_capacity, input_capacity, corner_capacity;
    double (*corner)[3]; /* the polygon at hand */
    uint32_t (*triangle)[3], *scratch;
};

/* Add one polygon: corner j is positions[3 * indices[j]]. It becomes one face, several, or none when it has no area.
 * Returns 0, or -1 when out of memory. */
int scene_builder_polygon(struct scene_builder *b, const double *positions, const uint32_t *indices, uint32_t size, uint32_t material);
/* After the last polygon. Returns 0. */
int scene_builder_end(struct scene_builder *b);
void scene_builder_free(struct scene_builder *b);

#endif
