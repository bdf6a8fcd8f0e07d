/* load_scene.h - a scene file as commands have it: read, committed, and its surfaces for the
 * writers.
 * SPDX-License-Identifier: MIT */
#ifndef LOAD_SCENE_H
#define LOAD_SCENE_H

#include <check.h>
#include "output/solution.h"
#include "scene/scene_file.h"

struct loaded {
    struct scene_file file;
    RadDevice device;
    RadScene scene;
    struct surfaces surfaces;
    struct RadSceneReport report;
};

static inline void load_scene(struct loaded *l, const char *path)
{
    const struct scene_options how = {.quiet = 1};
    ck_assert_int_eq(scene_file_read(&l->file, path, &how), 0);
    const struct RadPolygons polygons = scene_file_polygons(&l->file);
    l->device = radNewDevice(NULL);
    l->scene = radNewScene(l->device);
    ck_assert_int_eq(radSetSceneMaterials(l->scene, l->file.materials, l->file.material_count), 0);
    ck_assert_int_eq(radSetSceneSharedPolygons(l->scene, &polygons), 0);
    ck_assert_msg(radCommitScene(l->scene) == 0, "%s", radGetDeviceErrorMessage(l->device));
    ck_assert_int_eq(radGetSceneReport(l->scene, &l->report), 0);
    l->surfaces = surfaces_of(l->scene, l->file.polygon_materials, l->file.names);
}

static inline void unload_scene(struct loaded *l)
{
    radReleaseScene(l->scene);
    radReleaseDevice(l->device);
    scene_file_free(&l->file);
}

#endif
