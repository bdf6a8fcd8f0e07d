/* gathering.c - see gathering.h.
 * SPDX-License-Identifier: MIT */
#include "output/gathering.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "geometry.h"
#include "kernel/constants.h"
#include "kernel/hash.h"
#include "output/smoothing.h"
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

/* Of directions: the second has half as many */
enum { SETS = 2 };

/* While corners gather: of a vertex, its leaves together. Every point of theirs gathers by two
 * sets of directions. */
struct corner {
    double least;                /* radius of the smallest of them (m) */
    double sum[3];               /* of what both have told (W/m2) */
    double apart;                /* bands together: as noisy as that (APART) */
    uint32_t face;               /* of one of them */
    uint32_t leaves, next, told; /* how many; have had their turn; are not covered */
    int seen;
};

/* What gathering is worth: sums over vertices of the squared step from the mean of leaves to what
 * was gathered, and of the latter's squared error, as the two sets are apart. (These are spread so
 * evenly that what one's parts differ by would tell too much.) */
struct worth {
    double step, noise;
    uint32_t vertices;
};

/* That of places of a face that are alike bright: noise is not the same near a lamp and far off. */
enum { OCTAVES = 4 };

/* And what hangs on an edge that is seen. */
static void see_edge(struct corner *corners, const struct vertex_values *v, uint32_t a, uint32_t b,
                     uint32_t m)
{
    if (m == NO_VERTEX)
        return;
    corners[m].seen = 1;
    see_edge(corners, v, a, m, vertex_values_middle(v, a, m));
    see_edge(corners, v, m, b, vertex_values_middle(v, m, b));
}

static void note_corners(struct corner *corners, const struct vertex_values *v,
                         const struct solution *s, const uint8_t *seen)
{
    for (uint32_t i = 0; i < s->tree.count; i++) {
        const struct element *e = &s->tree.elements[i];
        for (uint32_t j = 0; is_leaf(e) && j < e->vertices; j++) {
            struct corner *c = &corners[v->corner[4 * (size_t)i + j]];
            c->least = c->least > 0 && c->least < e->radius ? c->least : e->radius;
            c->leaves++;
            c->face = e->face;
            c->seen |= seen[i];
            if (seen[i])
                see_edge(corners, v, v->corner[4 * (size_t)i + j],
                         v->corner[4 * (size_t)i + (j + 1u) % e->vertices],
                         v->middle[4 * (size_t)i + j]);
        }
    }
}

/* Where corner j of a leaf gathers: a part of the way to the centre, as long in all leaves there as
 * in the smallest. Together they have the directions that every vertex has, so that noise differs
 * little from one to the next. */
static struct RadGatherPoint corner_point(const struct element *e, uint32_t j,
                                          const struct corner *c, uint32_t rays)
{
    uint32_t first = rays * c->next / c->leaves, end = rays * (c->next + 1) / c->leaves;
    struct RadGatherPoint point = {.face = e->face, .first = first, .rays = end - first};
    for (int k = 0; k < 3; k++)
        point.position[k] =
            e->vertex[j][k]
            + GATHERING_INWARD * c->least / e->radius * (e->centre[k] - e->vertex[j][k]);
    return point;
}

/* Does the point lie under a solid that stands on the leaf? It sees the solid's inside alone, which
 * is black. */
static int is_covered(const struct solution *s, uint32_t leaf, const double *light)
{
    const struct RadFace *f = &s->surfaces.faces[s->tree.elements[leaf].face];
    for (uint32_t k = 0; k < s->tree.bands; k++)
        if (light[k] > s->surfaces.materials[f->material].exitance[k])
            return 0;
    return s->tree.uncovered && s->tree.uncovered[leaf] < 1;
}

/* Points of one part of the work. */
struct corner_points {
    struct RadGatherPoint *point;
    uint32_t *leaf, *vertex;
    double *light;
    size_t count;
};

static void push_point(struct corner_points *p, const struct RadGatherPoint *point, uint32_t leaf,
                       uint32_t vertex)
{
    p->point[p->count] = *point;
    p->leaf[p->count] = leaf;
    p->vertex[p->count++] = vertex;
}

/* What one set is above another that has half of its rays, times that, is as noisy as the mean of
 * both, by their rays: 2/3 of a variance for 3 of it */
#define APART 0.47140452079103168

/* Let them gather. Returns 0, or 1. */
static int gather_points(const struct gathering *g, struct corner *corners,
                         const struct solution *s, struct corner_points *p)
{
    uint32_t bands = s->tree.bands;
    if (radGather(g->solved, p->point, p->count, p->light) < 0)
        return 1;
    for (size_t i = 0; i < p->count; i += SETS) {
        const double *one = &p->light[i * bands], *other = one + bands;
        struct corner *c = &corners[p->vertex[i]];
        if (is_covered(s, p->leaf[i], one) && is_covered(s, p->leaf[i], other))
            continue;
        for (uint32_t k = 0; k < bands; k++) {
            c->sum[k] += (2 * one[k] + other[k]) / 3;
            c->apart += APART * (one[k] - other[k]);
        }
        c->told++;
    }
    p->count = 0;
    return 0;
}

/* ---- how far corners are believed */

static void add_worth(struct worth *sum, const struct worth *w)
{
    sum->step += w->step;
    sum->noise += w->noise;
    sum->vertices += w->vertices;
}

/* mean: of leaves, all bands together. */
static struct worth worth_of(const struct corner *c, double mean)
{
    const double step = (c->sum[0] + c->sum[1] + c->sum[2]) / c->told - mean,
                 off = c->apart / c->told;
    return (struct worth){step * step, off * off, 1};
}

/* How much of the step to take: as far as steps stand out of noise. [James and Stein 1961] */
static double believed(const struct worth *w)
{
    return w->step > w->noise ? 1 - w->noise / w->step : 0;
}

/* What gathering is worth at a vertex: by what is as bright on its face, by the face, or by all the
 * picture, the first that has corners enough to tell. */
static struct worth worth_at(const struct worth *face, int octave, const struct worth *all)
{
    struct worth whole = {0, 0, 0};
    if (face[octave].vertices >= GATHERING_TELLING)
        return face[octave];
    for (int i = 0; i < OCTAVES; i++)
        add_worth(&whole, &face[i]);
    return whole.vertices >= GATHERING_TELLING ? whole : *all;
}

/* What is left of both noises at a vertex once the share of a step is taken: of what was gathered
 * as it was there; of means of leaves, to either side by chance. */
static double noise_left(const struct corner *c, const struct worth *w, double share, uint32_t i)
{
    const double leaves =
        GATHERING_LEAVES * sqrt(fmax(w->step - w->noise, 0) / fmax(w->vertices, 1));
    return share * c->apart / c->told + (1 - share) * (hash64(i) & 1 ? leaves : -leaves);
}

/* Means of leaves go on towards what was gathered. noise[vertex]: what is left of it, NAN where
 * nothing was. Returns 0, or -1 when out of memory. */
static int take_steps(struct vertex_values *v, const struct solution *s,
                      const struct corner *corners, double *noise)
{
    uint32_t bands = v->bands;
    struct worth all = {0, 0, 0},
                 *faces = calloc((size_t)s->surfaces.face_count * OCTAVES + 1, sizeof *faces);
    unsigned char *octave = malloc((size_t)v->count + 1);
    for (uint32_t i = 0; faces && octave && i < v->count; i++) {
        double mean = 0;
        for (uint32_t k = 0; k < bands; k++)
            mean += v->value[(size_t)i * bands + k];
        octave[i] = mean > 0 ? (unsigned char)(ilogb(mean) & (OCTAVES - 1)) : 0;
        if (corners[i].told > 0) {
            struct worth own = worth_of(&corners[i], mean);
            add_worth(&faces[(size_t)corners[i].face * OCTAVES + octave[i]], &own);
            add_worth(&all, &own);
        }
    }
    for (uint32_t i = 0; faces && octave && i < v->count; i++) {
        const struct corner *c = &corners[i];
        const struct worth w = worth_at(&faces[(size_t)c->face * OCTAVES], octave[i], &all);
        const double share = believed(&w);
        noise[i] = c->told > 0 ? noise_left(c, &w, share, i) : NAN;
        for (uint32_t k = 0; k < bands && c->told > 0; k++) {
            double *value = &v->value[(size_t)i * bands + k];
            *value += share * (c->sum[k] / c->told - *value);
        }
    }
    int result = faces && octave ? 0 : -1;
    free(faces);
    free(octave);
    return result;
}

/* How many rays each corner may cast, for a picture of so many pixels: a power of two. */
static uint32_t rays_of_corners(const struct corner *corners, uint32_t count, double pixels)
{
    uint32_t rays = GATHERING_MOST;
    double all = 0;
    for (uint32_t i = 0; i < count; i++)
        all += corners[i].seen;
    while (rays > GATHERING_FEWEST && all * rays > GATHERING_SHARE * pixels)
        rays /= 2;
    return rays;
}

int gathering_corners(struct gathering *g, struct vertex_values *values,
                      const struct solution *solution, const uint8_t *seen, double pixels)
{
    enum { PART = 8192 };
    struct corner *corners = calloc((size_t)values->count + 1, sizeof *corners);
    double *noise = malloc(((size_t)values->count + 1) * sizeof *noise);
    struct corner_points p = {calloc(PART, sizeof *p.point), malloc(PART * sizeof *p.leaf),
                              malloc(PART * sizeof *p.vertex),
                              malloc((size_t)PART * values->bands * sizeof *p.light), 0};
    int result = corners && noise && p.point && p.leaf && p.vertex && p.light ? 0 : -1;
    if (result == 0)
        note_corners(corners, values, solution, seen);
    uint32_t rays = result == 0 ? rays_of_corners(corners, values->count, pixels) : 0;
    for (uint32_t i = 0; i < solution->tree.count && result == 0; i++) {
        const struct element *e = &solution->tree.elements[i];
        for (uint32_t j = 0; is_leaf(e) && j < e->vertices; j++) {
            uint32_t vertex = values->corner[4 * (size_t)i + j];
            if (!corners[vertex].seen || corners[vertex].leaves > rays / SETS)
                continue;
            for (uint32_t set = 0; set < SETS; set++) {
                struct RadGatherPoint point = corner_point(e, j, &corners[vertex], rays >> set);
                point.set = set;
                push_point(&p, &point, i, vertex);
            }
            corners[vertex].next++;
        }
        if (p.count <= PART - 8 && i + 1 < solution->tree.count)
            continue;
        result = gather_points(g, corners, solution, &p);
        if (g->progress)
            progress_say(g->progress, "gather  %.0f %% done", 100.0 * i / solution->tree.count);
    }
    if (result == 0)
        result = take_steps(values, solution, corners, noise);
    if (result == 0)
        result = smoothing_apply(values, solution, noise);
    free(corners);
    free(noise);
    free(p.point);
    free(p.leaf);
    free(p.vertex);
    free(p.light);
    return result ? fail(g, result) : 0;
}
