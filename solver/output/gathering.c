/* gathering.c - see gathering.h.
 * SPDX-License-Identifier: MIT */
#include "output/gathering.h"

#include <stdlib.h>
#include <string.h>

#include "geometry.h"
#include "kernel/constants.h"
#include "util/device.h"

/* Returns -1. */
static int fail(struct gathering *g, int result)
{
    if (result < 0)
        report_error(g->path, 0, "out of memory for the picture; ask for a smaller one");
    else
        report_device(g->device, g->path);
    g->failed = 1;
    return -1;
}

/* ---- pixels */

/* The samples of one pixel. */
struct pixel {
    int side, x, y, from; /* pixels; the row of pixels that sample rows begin with */
    const struct raster *r;
};

static size_t sample_of(const struct pixel *p, int j)
{
    size_t row = (size_t)((p->y - p->from) * p->side + j / p->side);
    return row * (size_t)p->r->width + (size_t)(p->x * p->side + j % p->side);
}

static size_t push_points(const struct pixel *p, const struct solution *s, const uint32_t *face,
                          uint32_t rays, struct RadGatherPoint *points)
{
    size_t count = 0;
    for (int j = 0; j < p->side * p->side; j++) {
        uint32_t f = face[sample_of(p, j)];
        double direction[3];
        if (f == NO_FACE)
            continue;
        struct RadGatherPoint *point = &points[count++];
        *point = (struct RadGatherPoint){.face = f,
                                         .set = (uint64_t)p->y * (uint64_t)(p->r->width / p->side)
                                                + (uint64_t)p->x,
                                         .first = (uint32_t)j * rays,
                                         .rays = rays};
        raster_point(p->r, s, f, p->x * p->side + j % p->side, p->y * p->side + j / p->side,
                     direction, point->position);
    }
    return count;
}

/* Give each sample of a pixel the mean over those that see the same face. `gathered`: of those that
 * see any, in their order. Returns how many. */
static size_t share_light(const struct pixel *p, uint32_t bands, const uint32_t *face,
                          const double *gathered, double *light)
{
    size_t count = 0;
    int n = p->side * p->side;
    for (int j = 0; j < n; j++) {
        size_t at = sample_of(p, j);
        for (uint32_t k = 0; k < bands; k++)
            light[at * bands + k] = face[at] == NO_FACE ? 0 : gathered[count * bands + k];
        count += face[at] != NO_FACE;
    }
    for (int j = 0; j < n; j++) {
        size_t at = sample_of(p, j);
        int first = 0, same = 0;
        double sum[3] = {0, 0, 0};
        while (face[sample_of(p, first)] != face[at])
            first++;
        if (first < j) { /* it has been summed up */
            memcpy(&light[at * bands], &light[sample_of(p, first) * bands], bands * sizeof *light);
            continue;
        }
        for (int i = j; i < n; i++) {
            size_t other = sample_of(p, i);
            if (face[other] != face[at])
                continue;
            same++;
            for (uint32_t k = 0; k < bands; k++)
                sum[k] += light[other * bands + k];
        }
        for (uint32_t k = 0; k < bands; k++)
            light[at * bands + k] = sum[k] / same;
    }
    return count;
}

int gathering_rows(struct gathering *g, const struct raster *r, const struct solution *solution,
                   int side, int from, int to, const uint32_t *face, double *light)
{
    int width = r->width / side, samples = side * side;
    uint32_t bands = solution->tree.bands;
    uint32_t each = (uint32_t)((g->rays + samples - 1) / samples);
    size_t all = (size_t)(to - from) * (size_t)width * (size_t)samples, count = 0;
    struct RadGatherPoint *points = calloc(all + 1, sizeof *points);
    double *gathered = malloc((all + 1) * bands * sizeof *gathered);
    int result = points && gathered ? 0 : -1;
    each = each < GATHERING_LEAST ? GATHERING_LEAST : each;
    struct pixel p = {.side = side, .from = from, .r = r};
    for (p.y = from; p.y < to && result == 0; p.y++)
        for (p.x = 0; p.x < width; p.x++)
            count += push_points(&p, solution, face, each, &points[count]);
    if (result == 0 && radGather(g->solved, points, count, gathered) < 0)
        result = 1;
    count = 0;
    for (p.y = from; p.y < to && result == 0; p.y++)
        for (p.x = 0; p.x < width; p.x++)
            count += share_light(&p, bands, face, &gathered[count * bands], light);
    free(points);
    free(gathered);
    if (g->progress)
        progress_say(g->progress, "gather  %.0f %% done", 100.0 * to * side / r->height);
    return result ? fail(g, result) : 0;
}

/* ---- corners */

/* While places are looked for: of a vertex, what its leaves say. */
struct corner {
    double inward[3]; /* sum of the ways to their centres (m) */
    uint32_t leaves, face;
    int seen;
};

static void note_corners(struct corner *corners, const struct vertex_values *v,
                         const struct solution *s, const uint8_t *seen)
{
    for (uint32_t i = 0; i < s->tree.count; i++) {
        const struct element *e = &s->tree.elements[i];
        for (uint32_t j = 0; is_leaf(e) && j < e->vertices; j++) {
            uint32_t at = v->corner[4 * (size_t)i + j];
            struct corner *c = &corners[at];
            c->leaves++;
            c->face = e->face;
            c->seen |= seen[i];
            for (int k = 0; k < 3; k++)
                c->inward[k] += e->centre[k] - v->vertices[at].position[k];
        }
    }
}

int gathering_corners(struct gathering *g, struct vertex_values *values,
                      const struct solution *solution, const uint8_t *seen)
{
    enum { PART = 8192 };
    uint32_t bands = values->bands;
    struct corner *corners = calloc((size_t)values->count + 1, sizeof *corners);
    struct RadGatherPoint *points = calloc(PART, sizeof *points);
    double *gathered = malloc((size_t)PART * bands * sizeof *gathered);
    uint32_t *of = malloc(PART * sizeof *of), at = 0;
    int result = corners && points && gathered && of ? 0 : -1;
    if (result == 0)
        note_corners(corners, values, solution, seen);
    while (at < values->count && result == 0) {
        size_t count = 0;
        for (; at < values->count && count < PART; at++) {
            const struct corner *c = &corners[at];
            if (!c->seen)
                continue;
            of[count] = at;
            points[count] = (struct RadGatherPoint){.face = c->face, .rays = GATHERING_CORNER};
            for (int k = 0; k < 3; k++)
                points[count].position[k] =
                    values->vertices[at].position[k] + GATHERING_INWARD * c->inward[k] / c->leaves;
            count++;
        }
        result = radGather(g->solved, points, count, gathered) < 0;
        for (size_t i = 0; i < count && result == 0; i++)
            memcpy(&values->value[(size_t)of[i] * bands], &gathered[i * bands],
                   bands * sizeof *gathered);
        if (g->progress)
            progress_say(g->progress, "gather  %.0f %% done", 100.0 * at / values->count);
    }
    free(corners);
    free(points);
    free(gathered);
    free(of);
    return result ? fail(g, result) : 0;
}
