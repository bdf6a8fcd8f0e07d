/* api_gather.c - light at points, gathered once more from what a solution shows.
 * SPDX-License-Identifier: MIT */
#include "engine/api.h"
#include "engine/solve_tracer.h"
#include "geometry.h"
#include "particles/gather.h"
#include "util/thread_pool.h"

static int check_points(RadSolution solution, const struct RadGatherPoint *points, size_t count)
{
    RadDevice device = solution->scene->device;
    const struct hierarchy *h = &solution->solve.hierarchy;
    const uint32_t faces = h->face_count;
    for (size_t i = 0; i < count; i++) {
        const struct RadGatherPoint *p = &points[i];
        if (p->face >= faces)
            return api_fail(device, RAD_ERROR_INVALID_ARGUMENT,
                            "point %zu of %zu is of face %u; there are %u, from 0", i, count,
                            (unsigned)p->face, (unsigned)faces);
        if (!api_place(p->position))
            return api_fail(device, RAD_ERROR_INVALID_ARGUMENT,
                            "point %zu of %zu is at no finite place", i, count);
        /* Embree ends the program where a ray comes from beyond its numbers */
        const struct element *e = hierarchy_surface(h, p->face);
        if (polygon_distance(p->position, e->vertex, e->vertices, e->normal)
            > h->elements[0].radius)
            return api_fail(device, RAD_ERROR_INVALID_ARGUMENT,
                            "point %zu of %zu is farther from its face, %u, than the scene is "
                            "large",
                            i, count, (unsigned)p->face);
        if (p->rays == 0 || p->rays > UINT32_MAX - p->first)
            return api_fail(device, RAD_ERROR_INVALID_ARGUMENT,
                            "point %zu of %zu has %u rays from number %u; it takes one or more, "
                            "below 2^32 with those before",
                            i, count, (unsigned)p->rays, (unsigned)p->first);
    }
    return 0;
}

struct gathering {
    const struct gather *gather;
    const struct RadGatherPoint *points;
    double *radiosity;
    uint32_t bands;
};

static void gather_points(const void *context, size_t from, size_t to)
{
    const struct gathering *w = context;
    for (size_t i = from; i < to; i++) {
        const struct RadGatherPoint *p = &w->points[i];
        gather_radiosity(w->gather, p->face, p->position, p->set, p->first, p->rays,
                         &w->radiosity[i * w->bands]);
    }
}

int radGather(RadSolution solution, const struct RadGatherPoint *points, size_t count,
              double *radiosity)
{
    if (api_solved(solution, "radGather") < 0)
        return -1;
    RadDevice device = solution->scene->device;
    if (count > 0 && (!points || !radiosity))
        return api_fail(device, RAD_ERROR_INVALID_ARGUMENT,
                        "radGather needs points, and room for their radiosities");
    if (check_points(solution, points, count) < 0)
        return -1;
    const struct solve *s = &solution->solve;
    const struct tracer t = solve_tracer(s);
    struct gather g;
    if (gather_open(&g, &t, solve_shown(s)->radiosity, solve_gradient(s)) < 0)
        return api_fail(device, RAD_ERROR_OUT_OF_MEMORY, "out of memory to gather light");
    const struct gathering work = {&g, points, radiosity, t.bands};
    thread_pool_run(t.threads, count, 64, gather_points, &work);
    gather_close(&g);
    return 0;
}
