/* api_points.c - what points see of a scene's polygons.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include "engine/api.h"
#include "geometry.h"
#include "util/ranks_loop.h"

/* Points that see; those of them that found no memory. */
struct seeing {
    const struct point_view *view;
    const double *position, *normal;
    double *row;
    atomic_int *failed;
};

static void see_points(const void *seeing, size_t from, size_t to)
{
    const struct seeing *s = seeing;
    for (size_t i = from; i < to; i++) {
        const double *n = &s->normal[3 * i];
        double size = length3(n), unit[3] = {n[0] / size, n[1] / size, n[2] / size};
        if (point_view_row(s->view, &s->position[3 * i], unit,
                           s->row + i * ((size_t)s->view->scene->input_count + 2))
            < 0)
            atomic_store(s->failed, 1);
    }
}

int radGetPointFactors(RadScene scene, uint32_t count, const double *position, const double *normal,
                       double *row)
{
    if (!scene)
        return -1;
    RadDevice device = scene->device;
    if (!scene->committed)
        return api_fail(device, RAD_ERROR_INVALID_OPERATION,
                        "radCommitScene comes before radGetPointFactors");
    if (count && (!position || !normal || !row))
        return api_fail(device, RAD_ERROR_INVALID_ARGUMENT,
                        "points need positions, normals and a place for %u values each",
                        (unsigned)scene->scene.input_count + 2);
    for (size_t i = 0; i < count; i++) {
        double size = length3(&normal[3 * i]);
        if (!api_place(&position[3 * i]) || !(size > 0) || !isfinite(size))
            return api_fail(device, RAD_ERROR_INVALID_ARGUMENT,
                            "point %u needs a finite position, within 3.4e38, and a normal that is "
                            "not 0",
                            (unsigned)i);
    }
    atomic_int failed;
    atomic_init(&failed,
                !scene->points.scene
                    && point_view_open(&scene->points, &scene->scene, device->threads) < 0);
    const struct seeing s = {&scene->points, position, normal, row, &failed};
    if (!ranks_any(device->ranks, atomic_load(&failed)))
        ranks_loop_run(device->ranks, RANKS_VALUES, device->threads, count, 1, see_points, &s, row,
                       ((size_t)scene->scene.input_count + 2) * sizeof *row);
    return ranks_any(device->ranks, atomic_load(&failed))
               ? api_fail(device, RAD_ERROR_OUT_OF_MEMORY, "out of memory for point view factors")
               : 0;
}
