/* api_scene.c - scenes: materials and polygons of the caller's, checked and made into faces by the
 * commit.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "engine/api.h"

/* A RadFace is a struct face under the name that programs know. */
_Static_assert(sizeof(struct RadFace) == sizeof(struct face)
                   && offsetof(struct RadFace, vertices) == offsetof(struct face, vertices)
                   && offsetof(struct RadFace, material) == offsetof(struct face, material)
                   && offsetof(struct RadFace, input) == offsetof(struct face, input)
                   && offsetof(struct RadFace, back) == offsetof(struct face, back)
                   && offsetof(struct RadFace, black) == offsetof(struct face, black),
               "RadFace is struct face");

RadScene radNewScene(RadDevice device)
{
    if (!device)
        return NULL;
    RadScene scene = calloc(1, sizeof *scene);
    if (!scene) {
        api_fail(device, RAD_ERROR_OUT_OF_MEMORY, "out of memory for a scene");
        return NULL;
    }
    atomic_init(&scene->holders, 1);
    scene->device = device;
    radRetainDevice(device);
    return scene;
}

void radRetainScene(RadScene scene)
{
    if (scene)
        atomic_fetch_add(&scene->holders, 1);
}

void radReleaseScene(RadScene scene)
{
    if (!scene || atomic_fetch_sub(&scene->holders, 1) != 1)
        return;
    point_view_close(&scene->points);
    scene_free(&scene->scene);
    free(scene->materials);
    radReleaseDevice(scene->device);
    free(scene);
}

static int not_after_commit(RadScene scene, const char *what)
{
    if (!scene->committed)
        return 0;
    return api_fail(scene->device, RAD_ERROR_INVALID_OPERATION,
                    "%s of a committed scene cannot be changed; make another scene", what);
}

int radSetSceneMaterials(RadScene scene, const struct RadMaterial *materials, uint32_t count)
{
    if (!scene || not_after_commit(scene, "the materials") < 0)
        return -1;
    if (!materials || count == 0)
        return api_fail(scene->device, RAD_ERROR_INVALID_ARGUMENT,
                        "a scene needs one material at least");
    struct RadMaterial *copy = malloc(count * sizeof *copy);
    if (!copy)
        return api_fail(scene->device, RAD_ERROR_OUT_OF_MEMORY, "out of memory for %u materials",
                        (unsigned)count);
    memcpy(copy, materials, count * sizeof *copy);
    free(scene->materials);
    scene->materials = copy;
    scene->material_count = count;
    return 0;
}

int radSetSceneSharedPolygons(RadScene scene, const struct RadPolygons *polygons)
{
    if (!scene || not_after_commit(scene, "the polygons") < 0)
        return -1;
    if (!polygons || polygons->count == 0)
        return api_fail(scene->device, RAD_ERROR_INVALID_ARGUMENT,
                        "a scene needs one polygon at least");
    if (!polygons->positions || !polygons->indices)
        return api_fail(scene->device, RAD_ERROR_INVALID_ARGUMENT, "RadPolygons has no %s",
                        polygons->positions ? "indices" : "positions");
    if (!polygons->sizes && polygons->size < 3)
        return api_fail(scene->device, RAD_ERROR_INVALID_ARGUMENT,
                        "polygons of %u corners: RadPolygons.size must be 3 or more, or "
                        "RadPolygons.sizes be given",
                        (unsigned)polygons->size);
    if (polygons->turned != RAD_TURNED_IGNORE && polygons->turned != RAD_TURNED_FIND
        && polygons->turned != RAD_TURNED_FLIP)
        return api_fail(scene->device, RAD_ERROR_INVALID_ARGUMENT,
                        "RadPolygons.turned takes one of enum RadTurned");
    scene->polygons = *polygons;
    scene->polygons_set = 1;
    return 0;
}

static void make_report(RadScene scene)
{
    const struct scene *s = &scene->scene;
    struct RadSceneReport *r = &scene->report;
    *r = (struct RadSceneReport){.polygons = s->input_count,
                                 .dropped = s->dropped,
                                 .crossing = s->crossing,
                                 .crossing_first = s->crossing_first,
                                 .cut = s->cut,
                                 .parts = s->parts,
                                 .overlaps = s->overlaps,
                                 .overlap_area = s->overlap_area,
                                 .turned_closed = s->turned_closed,
                                 .turned_open = s->turned_open,
                                 .faces = s->face_count,
                                 .materials = s->material_count,
                                 .bands = s->bands};
    memcpy(r->overlap, s->overlap, sizeof r->overlap);
    for (int k = 0; k < 3; k++) {
        r->low[k] = INFINITY;
        r->high[k] = -INFINITY;
    }
    for (uint32_t i = 0; i < scene->polygons.count; i++) {
        uint32_t material = scene->polygons.materials ? scene->polygons.materials[i] : 0;
        r->area += s->areas[i] * (s->materials[material].two_sided ? 2 : 1);
    }
    for (uint32_t i = 0; i < s->face_count; i++)
        for (uint32_t j = 0; j < s->faces[i].vertices; j++)
            for (int k = 0; k < 3; k++) {
                r->low[k] = fmin(r->low[k], s->faces[i].vertex[j][k]);
                r->high[k] = fmax(r->high[k], s->faces[i].vertex[j][k]);
            }
}

int radCommitScene(RadScene scene)
{
    if (!scene || not_after_commit(scene, "anything") < 0)
        return -1;
    if (!scene->materials || !scene->polygons_set)
        return api_fail(scene->device, RAD_ERROR_INVALID_OPERATION, "set %s before radCommitScene",
                        scene->materials ? "polygons" : "materials");
    struct scene_error error;
    if (scene_build(&scene->scene, &scene->polygons, scene->materials, scene->material_count,
                    scene->device->threads, &error)
        < 0)
        return api_fail(scene->device, error.code, "%s", error.text);
    make_report(scene);
    scene->polygons = (struct RadPolygons){0};
    free(scene->materials);
    scene->materials = NULL; /* the engine has its own */
    scene->committed = 1;
    return 0;
}

int radGetSceneReport(RadScene scene, struct RadSceneReport *report)
{
    if (!scene || api_needs(scene->device, report, "radGetSceneReport needs a place") < 0)
        return -1;
    if (!scene->committed)
        return api_fail(scene->device, RAD_ERROR_INVALID_OPERATION,
                        "radCommitScene comes before radGetSceneReport");
    *report = scene->report;
    return 0;
}

const struct RadFace *radGetSceneFaces(RadScene scene)
{
    return scene && scene->committed ? (const struct RadFace *)(const void *)scene->scene.faces
                                     : NULL;
}

const double *radGetScenePolygonAreas(RadScene scene)
{
    return scene && scene->committed ? scene->scene.areas : NULL;
}

const struct RadMaterial *radGetSceneMaterials(RadScene scene)
{
    return !scene ? NULL : scene->committed ? scene->scene.materials : scene->materials;
}
