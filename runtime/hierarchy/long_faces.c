/* long_faces.c - see long_faces.h.
 *
 * Elements are quartered, and a quarter is as long for its width as the whole: on the wall of a
 * tunnel, 500 m by 5, places between two lamps are as far apart as the ends of one element as wide
 * as a hand. So long quads are cut across beforehand, into parts no more than about twice as long
 * as wide, where they are large enough to be looked at for themselves and their parts are many
 * times as large as what solutions are judged by. All else stays as it is: a table's leg is long,
 * too.
 *
 * Invariants: parts have the face's orientation, and its area in sum; neighbours have the same
 * corners to the bit; lengths times 2^k give the same parts; a far side is cut like its front and
 * stays behind it. [Derived here]
 * SPDX-License-Identifier: MIT */
#include "hierarchy/long_faces.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "geometry.h"
#include "hierarchy/polygon.h"
#include "kernel/constants.h"

static double side(const struct face *f, int from, int to)
{
    double d[3];
    sub3(d, f->vertex[to], f->vertex[from]);
    return length3(d);
}

static double area_of(const struct face *f)
{
    double vertex[4][3], n[3];
    memcpy(vertex, f->vertex, sizeof vertex);
    return polygon_normal(vertex, f->vertices, n);
}

/* Into how many parts; *first: the corner that a long side begins at, 0 or 1. */
static uint32_t parts_of(const struct face *f, double whole, int *first)
{
    const double area = area_of(f), a = side(f, 0, 1) + side(f, 2, 3),
                 b = side(f, 1, 2) + side(f, 3, 0);
    if (f->vertices != 4 || !(area > LONG_AREA * whole))
        return 1;
    *first = a >= b ? 0 : 1;
    /* long over mean width, and its half */
    const double ratio = fmax(a, b) * fmax(a, b) / (4 * area), most = area / (LONG_PART * whole);
    return ratio < LONG_RATIO ? 1 : (uint32_t)fmax(1, fmin(0.5 * ratio, most));
}

/* The point i / n of the way from a to b. */
static void on_side(double p[3], const double a[3], const double b[3], uint32_t i, uint32_t n)
{
    for (int k = 0; k < 3; k++)
        p[k] = i == n ? b[k] : a[k] + (b[k] - a[k]) * ((double)i / n);
}

static void part_of(const struct face *f, int first, uint32_t i, uint32_t n, struct face *part)
{
    const int at[4] = {first, first + 1, (first + 2) % 4, (first + 3) % 4};
    *part = *f;
    on_side(part->vertex[0], f->vertex[at[0]], f->vertex[at[1]], i, n);
    on_side(part->vertex[1], f->vertex[at[0]], f->vertex[at[1]], i + 1, n);
    on_side(part->vertex[2], f->vertex[at[3]], f->vertex[at[2]], i + 1, n);
    on_side(part->vertex[3], f->vertex[at[3]], f->vertex[at[2]], i, n);
}

int scene_shorten(struct scene *scene)
{
    double whole = 0;
    size_t most = 0;
    int first = 0;
    for (uint32_t i = 0; i < scene->face_count; i++)
        whole += area_of(&scene->faces[i]);
    for (uint32_t i = 0; i < scene->face_count; i++)
        most += parts_of(&scene->faces[i], whole, &first);
    if (most == scene->face_count)
        return 0;
    struct face *faces = most <= UINT32_MAX ? malloc(most * sizeof *faces) : NULL;
    if (!faces)
        return -1;
    uint32_t count = 0;
    for (uint32_t i = 0; i < scene->face_count; i++) {
        const struct face *f = &scene->faces[i];
        const int pair = scene_is_pair(scene, i);
        const uint32_t parts = parts_of(f, whole, &first);
        scene->cut += parts > 1;
        scene->parts += parts > 1 ? parts : 0;
        for (uint32_t j = 0; j < parts; j++) {
            struct face *part = &faces[count++];
            if (parts > 1)
                part_of(f, first, j, parts, part);
            else
                *part = *f;
            if (pair) {
                struct face *back = &faces[count++];
                *back = f[1];
                for (int c = 0; c < 4 && parts > 1; c++)
                    memcpy(back->vertex[c], part->vertex[3 - c], sizeof back->vertex[c]);
            }
        }
        i += (uint32_t)pair;
    }
    free(scene->faces);
    scene->faces = faces;
    scene->face_count = count;
    return 0;
}
