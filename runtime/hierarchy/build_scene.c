/* build_scene.c - see build_scene.h.
 * SPDX-License-Identifier: MIT */
#include "hierarchy/build_scene.h"

#include <stdlib.h>
#include <string.h>
#include "hierarchy/polygon.h"

/* How far from its mean plane a quad's corner may lie, relative to the quad's size. */
static const double FLAT_QUAD = 1e-4;

/* Room for one more element of `size` bytes; NULL when there is none. */
static void *grown(void *array, uint32_t count, uint32_t *capacity, size_t size)
{
    if (count < *capacity)
        return array;
    uint32_t more = *capacity < 1024 ? 1024 : *capacity > UINT32_MAX / 2 ? UINT32_MAX : *capacity * 2;
    void *larger = count < more ? realloc(array, more * size) : NULL;
    if (larger)
        *capacity = more;
    return larger;
}

static int add_face(struct scene_builder *b, const uint32_t *corners, uint32_t count, uint32_t material, uint32_t input)
{
    struct scene *scene = b->scene;
    const struct material *m = &scene->materials[material];
    int black = 1;
    for (int k = 0; k < 3; k++)
        black &= m->reflectance[k] == 0 && m->exitance[k] == 0;
    for (int back = 0; back <= !!m->two_sided; back++) {
        struct face *larger = grown(scene->faces, scene->face_count, &b->face_capacity, sizeof *larger);
        if (!larger)
            return -1;
        scene->faces = larger;
        struct face *f = &larger[scene->face_count++];
        *f = (struct face){.vertices = count, .material = material, .input = input, .back = (uint8_t)back, .black = (uint8_t)black};
        for (uint32_t i = 0; i < count; i++)
            memcpy(f->vertex[i], b->corner[corners[back ? count - 1 - i : i]], sizeof f->vertex[i]);
    }
    return 0;
}

static int reserve_corners(struct scene_builder *b, uint32_t count)
{
    if (count <= b->corner_capacity)
        return 0;
    void *corner = realloc(b->corner, count * sizeof *b->corner);
    if (corner)
        b->corner = corner;
    void *triangle = realloc(b->triangle, count * sizeof *b->triangle);
    if (triangle)
        b->triangle = triangle;
    void *scratch = realloc(b->scratch, count * sizeof *b->scratch);
    if (scratch)
        b->scratch = scratch;
    if (!corner || !triangle || !scratch)
        return -1;
    b->corner_capacity = count;
    return 0;
}

/* The corners, where one given twice in a row is one: a quad at a pole is a triangle. Returns how many. */
static uint32_t take_corners(struct scene_builder *b, const double *positions, const uint32_t *indices, uint32_t size)
{
    uint32_t count = 0;
    for (uint32_t j = 0; j < size; j++) {
        const double *p = positions + 3 * (size_t)indices[j];
        if (!count || memcmp(p, b->corner[count - 1], sizeof b->corner[0]) != 0)
            memcpy(b->corner[count++], p, sizeof b->corner[0]);
    }
    while (count > 1 && memcmp(b->corner[0], b->corner[count - 1], sizeof b->corner[0]) == 0)
        count--;
    return count;
}

int scene_builder_polygon(struct scene_builder *b, const double *positions, const uint32_t *indices, uint32_t size, uint32_t material)
{
    struct scene *scene = b->scene;
    uint32_t input = scene->input_count, count, triangles;
    const uint32_t whole[4] = {0, 1, 2, 3};
    double normal[3];
    struct input_face *larger = grown(scene->inputs, input, &b->input_capacity, sizeof *larger);
    if (!larger || reserve_corners(b, size + 4) < 0)
        return -1;
    scene->inputs = larger;
    scene->input_count++;
    larger[input] = (struct input_face){.material = material};
    count = take_corners(b, positions, indices, size);
    if (polygon_degenerate(b->corner, count)) {
        scene->dropped++;
        return 0;
    }
    if (count == 3 || (count == 4 && polygon_flat(b->corner, 4, FLAT_QUAD) && polygon_convex_quad(b->corner))) {
        larger[input].area = polygon_normal(b->corner, count, normal);
        return add_face(b, whole, count, material, input);
    }
    triangles = polygon_triangulate(b->corner, count, b->triangle, b->scratch);
    for (uint32_t i = 0; i < triangles; i++) {
        double part[3][3];
        for (int k = 0; k < 3; k++)
            memcpy(part[k], b->corner[b->triangle[i][k]], sizeof part[k]);
        if (polygon_degenerate(part, 3))
            continue;
        larger[input].area += polygon_normal(part, 3, normal);
        if (add_face(b, b->triangle[i], 3, material, input))
            return -1;
    }
    if (!(larger[input].area > 0))
        scene->dropped++;
    return 0;
}

int scene_builder_end(struct scene_builder *b)
{
    struct scene *scene = b->scene;
    scene->bands = 1;
    for (uint32_t i = 0; i < scene->face_count; i++) {
        const double *rho = scene->materials[scene->faces[i].material].reflectance;
        const double *e = scene->materials[scene->faces[i].material].exitance;
        if (rho[0] != rho[1] || rho[1] != rho[2] || e[0] != e[1] || e[1] != e[2])
            scene->bands = 3;
    }
    return 0;
}

void scene_builder_free(struct scene_builder *b)
{
    free(b->corner);
    free(b->triangle);
    free(b->scratch);
    *b = (struct scene_builder){0};
}

void scene_free(struct scene *scene)
{
    for (uint32_t i = 0; i < scene->material_count; i++)
        free(scene->materials[i].name);
    free(scene->materials);
    free(scene->faces);
    free(scene->inputs);
    *scene = (struct scene){0};
}
