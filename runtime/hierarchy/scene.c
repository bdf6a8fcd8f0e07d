/* scene.c - polygons and materials to flat convex faces.
 *
 * Invariant: faces stand in the order of their polygons, whatever becomes of these; every face is
 * flat and convex, has an area, and names its polygon. Faces in which others stand are cut there
 * (cut_faces.h).
 * SPDX-License-Identifier: MIT */
#include "hierarchy/scene.h"

#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "hierarchy/crossing.h"
#include "hierarchy/cut_faces.h"
#include "hierarchy/long_faces.h"
#include "hierarchy/overlaps.h"
#include "hierarchy/polygon.h"
#include "hierarchy/shells.h"
#include "kernel/constants.h"
#include "util/array.h"
#include "util/thread_pool.h"

enum { NAMED = 1, SEEN = 2 };
enum { FEW = 2048 }; /* faces for which one thread does */

struct builder {
    struct scene *scene;
    const struct RadPolygons *polygons;
    uint8_t *used;       /* [material_count]: NAMED by a polygon, SEEN on one with an area */
    double (*corner)[3]; /* of the polygon at hand */
    uint32_t (*triangle)[3], *scratch;
    uint8_t *turned; /* [polygons->count], enum turned; NULL: nobody asked */
    struct round_parts round;
    size_t capacity;        /* faces that there is room for */
    double low[3], high[3]; /* box of all polygons (m) */
    double flat;            /* corners no farther than that from a plane are in it (m), for rays */
    struct scene_error *error;
};

#if defined __GNUC__
__attribute__((__format__(__printf__, 3, 4)))
#endif
static int
fail(struct scene_error *error, enum RadError code, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    error->code = code;
    vsnprintf(error->text, sizeof error->text, format, arguments);
    va_end(arguments);
    return -1;
}

static int out_of_memory(struct scene_error *error)
{
    return fail(error, RAD_ERROR_OUT_OF_MEMORY,
                "out of memory; use a smaller scene or a larger machine");
}

/* Materials that no polygon has may be anything. A weak lamp may be as weak as it is; where all
 * are, squares of powers, which noise is measured by, would be lost. */
static int check_materials(const struct builder *b)
{
    double brightest = 0;
    for (uint32_t i = 0; i < b->scene->material_count; i++) {
        const struct RadMaterial *m = &b->scene->materials[i];
        for (int k = 0; k < 3 && b->used[i]; k++) {
            if (!(m->reflectance[k] >= 0 && m->reflectance[k] < 1))
                return fail(b->error, RAD_ERROR_INVALID_SCENE,
                            "material %u has reflectance %g; it must be 0 or more and below 1",
                            (unsigned)i, m->reflectance[k]);
            if (!(m->exitance[k] >= 0 && m->exitance[k] <= (double)FLT_MAX))
                return fail(b->error, RAD_ERROR_INVALID_SCENE,
                            "material %u has exitance %g W/m2; it must be 0 or more and finite, "
                            "3.4e38 at most",
                            (unsigned)i, m->exitance[k]);
            brightest = fmax(brightest, m->exitance[k]);
        }
    }
    if (brightest > 0 && brightest < (double)FLT_MIN)
        return fail(b->error, RAD_ERROR_INVALID_SCENE,
                    "the brightest exitance is %g W/m2, too little to compute with; it must be "
                    "1.2e-38 or more, or 0 everywhere",
                    brightest);
    return 0;
}

static uint32_t size_of(const struct RadPolygons *polygons, uint32_t i)
{
    return polygons->sizes ? polygons->sizes[i] : polygons->size;
}

static uint32_t material_of(const struct RadPolygons *polygons, uint32_t i)
{
    return polygons->materials ? polygons->materials[i] : 0;
}

/* Check what the arrays refer to, mark the materials named, and find the largest polygon and how
 * many faces there may be. */
static int check_polygons(struct builder *b, uint32_t *largest, size_t *most)
{
    const struct RadPolygons *polygons = b->polygons;
    const enum RadError invalid = RAD_ERROR_INVALID_SCENE;
    size_t at = 0;
    *largest = 0;
    *most = 0;
    if (!polygons->count)
        return fail(b->error, invalid, "there is no face in it; a scene needs one face at least");
    if (!polygons->positions || !polygons->indices)
        return fail(b->error, invalid,
                    "faces without positions or without indices; give both arrays");
    for (uint32_t i = 0; i < polygons->count; i++) {
        uint32_t n = size_of(polygons, i), material = material_of(polygons, i);
        if (material >= b->scene->material_count)
            return fail(b->error, invalid,
                        "polygon %u has material %u, but there are %u; correct the index or set "
                        "more materials",
                        (unsigned)i, (unsigned)material, (unsigned)b->scene->material_count);
        b->used[material] = NAMED;
        for (uint32_t j = 0; j < n; j++) {
            uint32_t index = polygons->indices[at + j];
            if (index >= polygons->position_count)
                return fail(
                    b->error, invalid,
                    "corner %u of polygon %u is position %u, but there are %zu; correct the index",
                    (unsigned)j, (unsigned)i, (unsigned)index, polygons->position_count);
            const double *p = &polygons->positions[3 * (size_t)index];
            for (int k = 0; k < 3; k++) {
                if (!(fabs(p[k]) <= (double)FLT_MAX))
                    return fail(b->error, invalid,
                                "corner %u of polygon %u is %s (%g); correct position %u",
                                (unsigned)j, (unsigned)i,
                                isfinite(p[k]) ? "beyond 3.4e38" : "not finite", p[k],
                                (unsigned)index);
                b->low[k] = fmin(b->low[k], p[k]);
                b->high[k] = fmax(b->high[k], p[k]);
            }
        }
        at += n;
        *largest = n > *largest ? n : *largest;
        *most += (size_t)(n > 4   ? n - 2
                          : n > 3 ? 2
                                  : 1)
                 << !!b->scene->materials[material].two_sided;
    }
    return 0;
}

/* Add one of the input's faces, and its far side. Returns 0, or -1 when out of memory. */
static int add_face(struct builder *b, double (*vertex)[3], const uint32_t *corners, uint32_t count,
                    uint32_t input)
{
    uint32_t material = material_of(b->polygons, input);
    const struct RadMaterial *m = &b->scene->materials[material];
    int black = 1;
    double normal[3];
    if (b->scene->face_count > UINT32_MAX - 2
        || array_reserve(&b->scene->faces, (size_t)b->scene->face_count + 2, &b->capacity,
                         sizeof *b->scene->faces)
               < 0)
        return -1;
    for (int k = 0; k < 3; k++)
        black &= m->reflectance[k] <= 0 && m->exitance[k] <= 0;
    for (int back = 0; back <= !!m->two_sided; back++) {
        struct face *f = &b->scene->faces[b->scene->face_count++];
        *f = (struct face){.vertices = count,
                           .material = material,
                           .input = input,
                           .back = (uint8_t)back,
                           .black = (uint8_t)black};
        for (uint32_t i = 0; i < count; i++)
            memcpy(f->vertex[i], vertex[corners[back ? count - 1 - i : i]], sizeof f->vertex[i]);
        if (!back)
            b->scene->areas[input] += polygon_normal(f->vertex, count, normal);
    }
    return 0;
}

static int same_place(const double a[3], const double b[3])
{
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

/* The corners of a polygon that differ from the one before: a quad at a pole is a triangle. */
static uint32_t gather_corners(struct builder *b, const uint32_t *indices, uint32_t n)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < n; i++) {
        memcpy(b->corner[count], &b->polygons->positions[3 * (size_t)indices[i]],
               sizeof b->corner[0]);
        count += !count || !same_place(b->corner[count], b->corner[count - 1]);
    }
    while (count > 1 && same_place(b->corner[0], b->corner[count - 1]))
        count--;
    return count;
}

/* Is a polygon of three corners or four flat and convex? */
static int is_whole(const struct builder *b, double (*vertex)[3], uint32_t count)
{
    return count == 3
           || (count == 4
               && (b->polygons->as_given
                   || (polygon_flat(vertex, 4,
                                    fmin(b->flat, SCENE_FLAT_QUAD * polygon_size(vertex, 4)))
                       && polygon_convex_quad(vertex))));
}

static const uint32_t whole[4] = {0, 1, 2, 3}, halves[2][3] = {{0, 1, 2}, {0, 2, 3}};

/* Of an outline that crosses itself, all that it goes round. Returns 0, or -1 when out of memory.
 */
static int add_crossing(struct builder *b, uint32_t input, uint32_t count, const double normal[3])
{
    const double precision = b->scene->precision;
    if (crossing_parts(&b->round, b->corner, count, normal) < 0)
        return -1;
    for (size_t i = 0; i < b->round.count; i++) {
        struct round_part *p = &b->round.parts[i];
        int one = is_whole(b, p->vertex, p->n);
        for (int k = 0; k < 2 - one; k++) {
            const uint32_t *corners = one ? whole : halves[k], n = one ? p->n : 3;
            double part[4][3];
            for (uint32_t j = 0; j < n; j++)
                memcpy(part[j], p->vertex[corners[j]], sizeof part[j]);
            if (!polygon_degenerate(part, n, precision) && add_face(b, part, whole, n, input) < 0)
                return -1;
        }
    }
    return 0;
}

/* Run round the other way. */
static void flip_corners(double (*corner)[3], uint32_t n)
{
    for (uint32_t i = 0; i < n / 2; i++) {
        double p[3];
        memcpy(p, corner[i], sizeof p);
        memcpy(corner[i], corner[n - 1 - i], sizeof p);
        memcpy(corner[n - 1 - i], p, sizeof p);
    }
}

/* A polygon becomes one face, several, or none. Returns 0, or -1 when out of memory. */
static int add_polygon(struct builder *b, uint32_t input, const uint32_t *indices, uint32_t n)
{
    struct scene *scene = b->scene;
    uint32_t count = gather_corners(b, indices, n), before = scene->face_count;
    double normal[3], part[3][3];
    if (b->turned && b->turned[input] == TURNED_CLOSED && b->polygons->turned == RAD_TURNED_FLIP)
        flip_corners(b->corner, count);
    int none = polygon_degenerate(b->corner, count, scene->precision), crosses = 0, result = 0,
        apart = 0;
    if (!none && is_whole(b, b->corner, count)) {
        result = add_face(b, b->corner, whole, count, input);
    } else if (!none) {
        uint32_t triangles = polygon_triangulate(b->corner, count, b->triangle, b->scratch);
        crosses = !triangles;
        polygon_normal(b->corner, count, normal);
        for (uint32_t i = 0; i < triangles && !result; i++) {
            for (int k = 0; k < 3; k++)
                memcpy(part[k], b->corner[b->triangle[i][k]], sizeof part[k]);
            if (!polygon_degenerate(part, 3, scene->precision))
                result = add_face(b, b->corner, b->triangle[i], 3, input);
        }
        /* Ears are cut off some outlines that cross themselves, too. */
        apart = triangles > 2 && polygon_simple(b->corner, count);
    } else if (count > 3) { /* loops that run opposite ways may cancel out */
        double size = polygon_size(b->corner, count);
        crosses = crossing_normal(b->corner, count, normal) > SCENE_THIN * size * size;
    }
    if (crosses) {
        apart = 1;
        result = add_crossing(b, input, count, normal);
        if (!none || scene->face_count > before)
            scene->crossing_first = scene->crossing++ ? scene->crossing_first : input;
    }
    for (uint32_t i = before; i < scene->face_count; i++)
        scene->faces[i].apart = (uint8_t)apart;
    if (scene->face_count > before)
        b->used[material_of(b->polygons, input)] = SEEN;
    else
        scene->dropped++;
    return result;
}

static uint32_t bands(const struct builder *b)
{
    for (uint32_t i = 0; i < b->scene->material_count; i++) {
        const double *rho = b->scene->materials[i].reflectance,
                     *e = b->scene->materials[i].exitance;
        for (int k = 1; k < 3 && b->used[i] == SEEN; k++)
            if (rho[k] < rho[0] || rho[k] > rho[0] || e[k] < e[0] || e[k] > e[0])
                return RAD_COLOUR;
    }
    return RAD_GREY;
}

/* Take off faces what is covered, then cut them where others stand, and if asked for long ones
 * across. Returns 0 or -1. */
static int part_faces(struct scene *scene, int cut_long, int threads)
{
    struct bvh tree;
    threads = scene->face_count < FEW ? 1 : threads > 0 ? threads : thread_pool_processors();
    if (bvh_build(&tree, scene->faces, scene->face_count, CLUSTERING_SAH, threads) < 0)
        return -1;
    long changed = overlaps_take(scene, &tree, threads);
    if (changed > 0) {
        bvh_free(&tree);
        if (bvh_build(&tree, scene->faces, scene->face_count, CLUSTERING_SAH, threads) < 0)
            return -1;
    }
    int result = changed < 0 || scene_cut(scene, &tree, threads) < 0 ? -1 : 0;
    bvh_free(&tree);
    return result == 0 && cut_long ? scene_shorten(scene) : result;
}

/* The longest side of the box of what has not been dropped (m). */
static double width_of_faces(const struct scene *scene)
{
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY},
           width = 0;
    for (uint32_t i = 0; i < scene->face_count; i++)
        for (uint32_t j = 0; j < scene->faces[i].vertices; j++)
            for (int k = 0; k < 3; k++) {
                low[k] = fmin(low[k], scene->faces[i].vertex[j][k]);
                high[k] = fmax(high[k], scene->faces[i].vertex[j][k]);
                width = fmax(width, high[k] - low[k]);
            }
    return width;
}

static void name_turned(struct RadTurnedPolygons *all, uint32_t polygon)
{
    if (all->count < RAD_TURNED_NAMED)
        all->polygon[all->count] = polygon;
    all->count++;
}

/* Which polygons look turned. Returns 0 or -1. */
static int find_turned(struct builder *b)
{
    b->turned = malloc((size_t)b->polygons->count + 1);
    return b->turned && shells_find(b->polygons, b->scene->materials, b->turned) == 0 ? 0 : -1;
}

/* What has no area has no side that it could turn. */
static void name_all_turned(const struct builder *b)
{
    struct scene *s = b->scene;
    for (uint32_t i = 0; i < s->input_count && b->turned; i++)
        if (b->turned[i] != TURNED_NOT && s->areas[i] > 0)
            name_turned(b->turned[i] == TURNED_CLOSED ? &s->turned_closed : &s->turned_open, i);
}

static int build(struct builder *b, int threads)
{
    struct scene *scene = b->scene;
    size_t at = 0;
    b->used = calloc((size_t)scene->material_count + 1, 1);
    if (!b->used)
        return out_of_memory(b->error);
    uint32_t largest;
    size_t most;
    if (check_polygons(b, &largest, &most) || check_materials(b))
        return -1;
    if (b->polygons->turned != RAD_TURNED_IGNORE && find_turned(b) < 0)
        return out_of_memory(b->error);
    scene->faces = most <= UINT32_MAX ? malloc((most + 1) * sizeof *scene->faces) : NULL;
    b->capacity = scene->faces ? most + 1 : 0;
    scene->areas = calloc(b->polygons->count, sizeof *scene->areas);
    b->corner = malloc(((size_t)largest + 1) * sizeof *b->corner);
    b->triangle = malloc(((size_t)largest + 1) * sizeof *b->triangle);
    b->scratch = malloc(((size_t)largest + 1) * sizeof *b->scratch);
    if (!scene->faces || !scene->areas || !b->corner || !b->triangle || !b->scratch)
        return out_of_memory(b->error);
    scene->input_count = b->polygons->count;
    scene->precision = b->polygons->single_precision ? SCENE_SINGLE : SCENE_DOUBLE;
    double extent =
        fmax(fmax(b->high[0] - b->low[0], b->high[1] - b->low[1]), b->high[2] - b->low[2]);
    b->flat = SCENE_FLAT_FOR_RAYS * extent;
    for (uint32_t i = 0; i < scene->input_count; i++) {
        if (add_polygon(b, i, &b->polygons->indices[at], size_of(b->polygons, i)) < 0)
            return out_of_memory(b->error);
        at += size_of(b->polygons, i);
    }
    name_all_turned(b);
    if (!scene->face_count)
        return fail(b->error, RAD_ERROR_INVALID_SCENE,
                    "all of its %u faces are degenerate; give one face with an area",
                    (unsigned)scene->dropped);
    const double width = width_of_faces(scene);
    if (width < SCENE_LEAST || width > SCENE_MOST)
        return fail(b->error, RAD_ERROR_INVALID_SCENE,
                    "it is %g m wide, %s than any scene; coordinates are metres: scale it", width,
                    width < SCENE_LEAST ? "less" : "more");
    struct face *fitting = realloc(scene->faces, scene->face_count * sizeof *fitting);
    scene->faces = fitting ? fitting : scene->faces;
    scene->bands = bands(b);
    return !b->polygons->as_given && part_faces(scene, b->polygons->cut_long, threads) < 0
               ? out_of_memory(b->error)
               : 0;
}

int scene_build(struct scene *scene, const struct RadPolygons *polygons,
                const struct RadMaterial *materials, uint32_t material_count, int threads,
                struct scene_error *error)
{
    struct builder b = {.scene = scene,
                        .polygons = polygons,
                        .error = error,
                        .low = {INFINITY, INFINITY, INFINITY},
                        .high = {-INFINITY, -INFINITY, -INFINITY}};
    *scene = (struct scene){.materials = malloc(((size_t)material_count + 1) * sizeof *materials),
                            .material_count = material_count};
    *error = (struct scene_error){0};
    int result;
    if (scene->materials) {
        if (material_count)
            memcpy(scene->materials, materials, material_count * sizeof *materials);
        result = build(&b, threads);
    } else {
        result = out_of_memory(error);
    }
    free(b.used);
    free(b.turned);
    free(b.corner);
    free(b.triangle);
    free(b.scratch);
    free(b.round.parts);
    if (result)
        scene_free(scene);
    return result;
}

void scene_free(struct scene *scene)
{
    free(scene->materials);
    free(scene->faces);
    free(scene->lit);
    free(scene->areas);
    *scene = (struct scene){0};
}
