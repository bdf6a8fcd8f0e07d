/* api_scene.c - scenes: materials and polygons of the caller's, checked and made into faces by the commit.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "engine/api.h"
#include "hierarchy/build_scene.h"
#include "hierarchy/cut_faces.h"

/* A RadFace is a struct face under the name that programs know. */
_Static_assert(sizeof(struct RadFace) == sizeof(struct face) && offsetof(struct RadFace, vertices) == offsetof(struct face, vertices)
                   && offsetof(struct RadFace, material) == offsetof(struct face, material)
                   && offsetof(struct RadFace, input) == offsetof(struct face, input)
                   && offsetof(struct RadFace, back) == offsetof(struct face, back)
                   && offsetof(struct RadFace, black) == offsetof(struct face, black), "RadFace is struct face");

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
    scene_free(&scene->scene);
    free(scene->materials);
    free(scene->areas);
    radReleaseDevice(scene->device);
    free(scene);
}

static int not_after_commit(RadScene scene, const char *what)
{
    if (!scene->committed)
        return 0;
    return api_fail(scene->device, RAD_ERROR_INVALID_OPERATION, "%s of a committed scene cannot be changed; make another scene", what);
}

int radSetSceneMaterials(RadScene scene, const struct RadMaterial *materials, uint32_t count)
{
    if (!scene || not_after_commit(scene, "the materials") < 0)
        return -1;
    if (!materials || count == 0)
        return api_fail(scene->device, RAD_ERROR_INVALID_ARGUMENT, "a scene needs one material at least");
    struct RadMaterial *copy = malloc(count * sizeof *copy);
    if (!copy)
        return api_fail(scene->device, RAD_ERROR_OUT_OF_MEMORY, "out of memory for %u materials", (unsigned)count);
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
        return api_fail(scene->device, RAD_ERROR_INVALID_ARGUMENT, "a scene needs one polygon at least");
    if (!polygons->positions || !polygons->indices)
        return api_fail(scene->device, RAD_ERROR_INVALID_ARGUMENT, "RadPolygons has no %s", polygons->positions ? "indices" : "positions");
    if (!polygons->sizes && polygons->size < 3)
        return api_fail(scene->device, RAD_ERROR_INVALID_ARGUMENT,
                        "polygons of %u corners: RadPolygons.size must be 3 or more, or RadPolygons.sizes be given", (unsigned)polygons->size);
    scene->polygons = *polygons;
    scene->polygons_set = 1;
    return 0;
}

static uint32_t polygon_size_of(const struct RadPolygons *p, uint32_t i)
{
    return p->sizes ? p->sizes[i] : p->size;
}

static uint32_t polygon_material(const struct RadPolygons *p, uint32_t i)
{
    return p->materials ? p->materials[i] : 0;
}

static int check_polygons(RadScene scene)
{
    const struct RadPolygons *p = &scene->polygons;
    size_t at = 0;
    for (uint32_t i = 0; i < p->count; i++) {
        uint32_t size = polygon_size_of(p, i), material = polygon_material(p, i);
        if (size < 3)
            return api_fail(scene->device, RAD_ERROR_INVALID_SCENE, "polygon %u has %u corners; it needs 3 or more", (unsigned)i, (unsigned)size);
        if (material >= scene->material_count)
            return api_fail(scene->device, RAD_ERROR_INVALID_SCENE, "polygon %u has material %u, but there are %u, from 0", (unsigned)i,
                            (unsigned)material, (unsigned)scene->material_count);
        for (uint32_t j = 0; j < size; j++, at++) {
            if (p->indices[at] >= p->position_count)
                return api_fail(scene->device, RAD_ERROR_INVALID_SCENE, "corner %u of polygon %u is position %u, but there are %zu, from 0",
                                (unsigned)j, (unsigned)i, (unsigned)p->indices[at], p->position_count);
            if (!api_finite(p->positions + 3 * (size_t)p->indices[at], 3))
                return api_fail(scene->device, RAD_ERROR_INVALID_SCENE, "position %u, corner %u of polygon %u, is not finite; correct its coordinates",
                                (unsigned)p->indices[at], (unsigned)j, (unsigned)i);
        }
    }
    return 0;
}

/* Materials that no polygon has may hold anything. */
static int check_materials(RadScene scene)
{
    const struct RadPolygons *p = &scene->polygons;
    for (uint32_t i = 0; i < p->count; i++) {
        uint32_t material = polygon_material(p, i);
        const struct RadMaterial *m = &scene->materials[material];
        for (int k = 0; k < 3; k++) {
            if (!(m->reflectance[k] >= 0 && m->reflectance[k] < 1))
                return api_fail(scene->device, RAD_ERROR_INVALID_SCENE, "material %u, of polygon %u, has reflectance %g; it must be 0 or more and below 1",
                                (unsigned)material, (unsigned)i, m->reflectance[k]);
            if (!(m->exitance[k] >= 0 && isfinite(m->exitance[k])))
                return api_fail(scene->device, RAD_ERROR_INVALID_SCENE, "material %u, of polygon %u, has exitance %g W/m2; it must be 0 or more and finite",
                                (unsigned)material, (unsigned)i, m->exitance[k]);
        }
    }
    return 0;
}

static int copy_materials(struct scene *to, const RadScene from)
{
    to->materials = calloc(from->material_count, sizeof *to->materials);
    if (!to->materials)
        return -1;
    to->material_count = from->material_count;
    for (uint32_t i = 0; i < from->material_count; i++) {
        memcpy(to->materials[i].reflectance, from->materials[i].reflectance, sizeof to->materials[i].reflectance);
        memcpy(to->materials[i].exitance, from->materials[i].exitance, sizeof to->materials[i].exitance);
        to->materials[i].two_sided = from->materials[i].two_sided;
    }
    return 0;
}

static int make_faces(RadScene scene)
{
    const struct RadPolygons *p = &scene->polygons;
    struct scene *s = &scene->scene;
    struct scene_builder b = { .scene = s };
    size_t at = 0;
    int status = copy_materials(s, scene);
    for (uint32_t i = 0; i < p->count && status == 0; i++) {
        uint32_t size = polygon_size_of(p, i);
        status = scene_builder_polygon(&b, p->positions, p->indices + at, size, polygon_material(p, i));
        at += size;
    }
    if (status == 0 && s->face_count)
        status = scene_cut(s);
    if (status == 0)
        status = scene_builder_end(&b);
    scene_builder_free(&b);
    scene->areas = malloc(p->count * sizeof *scene->areas);
    if (status < 0 || !scene->areas)
        return api_fail(scene->device, RAD_ERROR_OUT_OF_MEMORY, "out of memory for a scene of %u polygons", (unsigned)p->count);
    if (!s->face_count)
        return api_fail(scene->device, RAD_ERROR_INVALID_SCENE, "all of the %u polygons are degenerate; give one with an area", (unsigned)p->count);
    for (uint32_t i = 0; i < p->count; i++)
        scene->areas[i] = s->inputs[i].area;
    return 0;
}

static void make_report(RadScene scene)
{
    const struct scene *s = &scene->scene;
    struct RadSceneReport *r = &scene->report;
    *r = (struct RadSceneReport){ .polygons = s->input_count, .dropped = s->dropped, .cut = s->cut, .parts = s->parts,
                                  .faces = s->face_count, .materials = s->material_count, .bands = s->bands };
    for (int k = 0; k < 3; k++) {
        r->low[k] = INFINITY;
        r->high[k] = -INFINITY;
    }
    for (uint32_t i = 0; i < s->input_count; i++)
        r->area += s->inputs[i].area * (s->materials[s->inputs[i].material].two_sided ? 2 : 1);
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
        return api_fail(scene->device, RAD_ERROR_INVALID_OPERATION, "set %s before radCommitScene", scene->materials ? "polygons" : "materials");
    if (check_polygons(scene) < 0 || check_materials(scene) < 0)
        return -1;
    if (make_faces(scene) < 0) {
        scene_free(&scene->scene);
        free(scene->areas);
        scene->areas = NULL;
        return -1;
    }
    make_report(scene);
    scene->polygons = (struct RadPolygons){ 0 };
    scene->committed = 1;
    return 0;
}

int radGetSceneReport(RadScene scene, struct RadSceneReport *report)
{
    if (!scene || !report)
        return -1;
    if (!scene->committed)
        return api_fail(scene->device, RAD_ERROR_INVALID_OPERATION, "radCommitScene comes before radGetSceneReport");
    *report = scene->report;
    return 0;
}

const struct RadFace *radGetSceneFaces(RadScene scene)
{
    return scene && scene->committed ? (const struct RadFace *)(const void *)scene->scene.faces : NULL;
}

const double *radGetScenePolygonAreas(RadScene scene)
{
    return scene && scene->committed ? scene->areas : NULL;
}

const struct RadMaterial *radGetSceneMaterials(RadScene scene)
{
    return scene ? scene->materials : NULL;
}
