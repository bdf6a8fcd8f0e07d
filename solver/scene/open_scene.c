/* open_scene.c - see open_scene.h.
 * SPDX-License-Identifier: MIT */
#include "scene/open_scene.h"

#include <string.h>

#include "kernel/hash.h"
#include "util/device.h"
#include "util/machines.h"
#include "util/report.h"

/* Behind another hash, that of so many bytes. */
static uint64_t mix(uint64_t hash, const void *bytes, size_t size)
{
    const unsigned char *at = bytes;
    for (size_t i = 0; i < size; i += sizeof hash) {
        uint64_t word = 0;
        memcpy(&word, at + i, size - i < sizeof word ? size - i : sizeof word);
        hash = hash64(hash + HASH_STEP + word);
    }
    return hash;
}

/* Of what is solved. */
static uint64_t identity(const struct scene_file *f)
{
    uint64_t hash = mix(f->polygon_count, f->positions, 3 * f->position_count * sizeof(double));
    hash = mix(hash, f->indices, f->index_count * sizeof *f->indices);
    hash = mix(hash, f->sizes, f->polygon_count * sizeof *f->sizes);
    hash = mix(hash, f->polygon_materials, f->polygon_count * sizeof *f->polygon_materials);
    for (uint32_t i = 0; i < f->material_count; i++) {
        const struct RadMaterial *m = &f->materials[i]; /* which has gaps */
        hash = mix(hash, m->reflectance, sizeof m->reflectance);
        hash = mix(hash, m->exitance, sizeof m->exitance);
        hash = mix(hash, &m->two_sided, sizeof m->two_sided);
    }
    return hash;
}

/* Several machines may have a file of this name each, and ranks that work on different scenes would
 * find wrong numbers, or wait for each other. */
static int read_alike(const struct scene_file *f, const char *path)
{
    if (machines_count() == 1 || machines_alike(identity(f)))
        return 0;
    return report_error(path, 0,
                        "the processes have read different scenes; give all of them the same file, "
                        "and the same materials beside it");
}

int open_whole_scene(struct open_scene *s, const char *path, const struct scene_options *options,
                     const struct copies *copies, enum RadTurned turned, int threads)
{
    *s = (struct open_scene){.path = path};
    int failed = scene_file_read(&s->file, path, options) < 0;
    s->originals = s->file.polygon_count;
    failed = failed || (copies && copies_add(&s->file, path, copies) < 0);
    if (machines_agree(failed) || read_alike(&s->file, path) < 0)
        return close_scene(s), -1;
    struct RadPolygons polygons = scene_file_polygons(&s->file);
    polygons.turned = turned;
    polygons.cut_long = !options->long_stay;
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
