/* read_scene.c - see read_scene.h.
 * SPDX-License-Identifier: MIT */
#include "scene/read_scene.h"

#include <string.h>

#include "util/report.h"

int scene_read(struct scene *scene, const char *path, const struct scene_options *options)
{
    struct scene_file file;
    *scene = (struct scene){0};
    if (scene_file_read(&file, path, options))
        return -1;
    const struct RadPolygons polygons = scene_file_polygons(&file);
    struct scene_error error;
    int result = scene_build(scene, &polygons, file.materials, file.material_count, 0, &error);
    if (result) {
        report_error(path, 0, "%s", error.text);
    } else {
        struct RadSceneReport report = {.dropped = scene->dropped,
                                        .crossing = scene->crossing,
                                        .crossing_first = scene->crossing_first,
                                        .overlaps = scene->overlaps,
                                        .overlap_area = scene->overlap_area};
        memcpy(report.overlap, scene->overlap, sizeof report.overlap);
        if (!options || !options->quiet)
            scene_file_warn(&file, path, &report, RAD_TURNED_IGNORE);
    }
    scene_file_free(&file);
    return result;
}
