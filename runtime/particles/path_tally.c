/* path_tally.c - see path_tally.h.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include "particles/path_tally.h"

int path_tally_open(struct path_tally *y, const struct tracer *t, uint64_t stream)
{
    *y = (struct path_tally){.paths = {.share = NULL}};
    if (tally_open(&y->tally, t, stream, 0) < 0)
        return -1;
    y->tally.by_paths = 1;
    for (uint32_t k = 0; k < t->bands; k++)
        y->tally.square[k] = 1;
    return face_paths_open(&y->paths, t, stream, 1);
}

void path_tally_close(struct path_tally *y)
{
    face_paths_close(&y->paths);
    tally_close(&y->tally);
}

/* Powers of all faces, as counts. */
static void count(struct path_tally *y, const struct tracer *t, const double *irradiance)
{
    struct tally *to = &y->tally;
    uint64_t all = 0;
    for (uint32_t f = 0; f < to->faces; f++)
        all += face_paths_count(&y->paths, f, y->paths.paths);
    to->particles = all / REPLICATES;
    to->rays = y->paths.rays;
    const double unit = tally_unit(to);
    for (uint32_t f = 0; f < to->faces && unit > 0; f++) {
        if (!tally_holds(to, f))
            continue;
        const uint32_t element = t->hierarchy->face_element[f];
        const double area = t->hierarchy->elements[element].area,
                     n = (double)(face_paths_count(&y->paths, f, y->paths.paths) / REPLICATES);
        for (int r = 0; r < REPLICATES; r++)
            for (uint32_t k = 0; k < to->bands; k++) {
                const size_t at = (size_t)f * to->bands + k,
                             place = (size_t)r * to->held + tally_place(to, f);
                const double H = n > 0 ? y->paths.replicate[r][at] / n
                                       : irradiance[(size_t)element * to->bands + k];
                to->face[place * to->bands + k] = llround(H * area / unit);
            }
    }
}

int path_tally_trace(struct path_tally *y, const struct tracer *t, const double *irradiance,
                     uint64_t paths, const struct watch *watch)
{
    if (face_paths_trace(&y->paths, t, paths, watch) < 0)
        return -1;
    count(y, t, irradiance);
    return 0;
}

int path_tally_trace_rays(struct path_tally *y, const struct tracer *t, const double *irradiance,
                          uint64_t rays, const struct watch *watch)
{
    if (path_tally_trace(y, t, irradiance, 1, watch) < 0)
        return -1;
    double all = (double)y->tally.particles * REPLICATES,
           more = (double)rays / (double)y->tally.rays;
    return more > 1 ? path_tally_trace(y, t, irradiance, (uint64_t)(more * all), watch) : 0;
}
