/* open_scene.c - see open_scene.h.
 * SPDX-License-Identifier: MIT */
#include "scene/open_scene.h"

#include "kernel/hash_bytes.h"
#include "util/device.h"
#include "util/machines.h"
#include "util/read_alike.h"

/* Of what is solved. */
static uint64_t identity(const struct scene_file *f)
{
    uint64_t hash =
        hash_bytes(f->polygon_count, f->positions, 3 * f->position_count * sizeof(double));
    hash = hash_bytes(hash, f->indices, f->index_count * sizeof *f->indices);
    hash = hash_bytes(hash, f->sizes, f->polygon_count * sizeof *f->sizes);
    hash = hash_bytes(hash, f->polygon_materials, f->polygon_count * sizeof *f->polygon_materials);
    for (uint32_t i = 0; i < f->material_count; i++) {
        const struct RadMaterial *m = &f->materials[i]; /* which has gaps */
        hash = hash_bytes(hash, m->reflectance, sizeof m->reflectance);
        hash = hash_bytes(hash, m->exitance, sizeof m->exitance);
        hash = hash_bytes(hash, &m->two_sided, sizeof m->two_sided);
    }
    return hash;
}

int open_whole_scene(struct open_scene *s, const char *path, const struct scene_options *options,
                     const struct copies *copies, enum RadTurned turned, int threads)
{
    *s = (struct open_scene){.path = path};
    int failed = scene_file_read(&s->file, path, options) < 0;
    s->originals = s->file.polygon_count;
    failed = failed || (copies && copies_add(&s->file, path, copies) < 0);
    if (machines_agree(failed)
        || (machines_count() > 1 && read_alike(path, identity(&s->file)) < 0))
        return close_scene(s), -1;
    struct RadPolygons polygons = scene_file_polygons(&s->file);
    polygons.turned = turned;
    polygons.cut_long = !options->factors_alone;
    s->device = open_device(threads);
    if (s->device) {
        s->scene = radNewScene(s->device);
        if (s->scene
            && radSetSceneMaterials(s->scene, s->file.materials, s->file.material_count) == 0
            && radSetSceneSharedPolygons(s->scene, &polygons) == 0 && radCommitScene(s->scene) == 0
            && radGetSceneReport(s->scene, &s->report) == 0) {
            if (scene_file_check_rounding(&s->file, path, &s->report) < 0) {
                close_scene(s);
                return -1;
            }
            if (!options->quiet)
                scene_file_warn(&s->file, path, &s->report, turned);
            return 0;
        }
        report_device(s->device, path);
    }
    close_scene(s);
    return -1;
}

void close_scene(struct open_scene *s)
{
    radReleaseScene(s->scene);
    radReleaseDevice(s->device);
    scene_file_free(&s->file);
    *s = (struct open_scene){0};
}
