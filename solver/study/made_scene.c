/* made_scene.c - see made_scene.h.
 * SPDX-License-Identifier: MIT */
#include "study/made_scene.h"

#include "util/device.h"

RadScene made_commit(const struct made_scene *made, RadDevice device, const char *where)
{
    const struct RadPolygons polygons = {.positions = made->position[0],
                                         .position_count = made->corners,
                                         .indices = made->index,
                                         .sizes = made->size,
                                         .materials = made->material,
                                         .count = made->count,
                                         .as_given = made->as_given};
    RadScene scene = radNewScene(device);
    if (scene && radSetSceneMaterials(scene, made->materials, made->material_count) == 0
        && radSetSceneSharedPolygons(scene, &polygons) == 0 && radCommitScene(scene) == 0)
        return scene;
    report_device(device, where);
    radReleaseScene(scene);
    return NULL;
}
