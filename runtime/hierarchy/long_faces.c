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

/* The mean length of the long sides, which begin at corners *first, 0 or 1, and *first + 2. */
static double long_side(const struct face *f, int *first)
{
    double sides[2] = {0, 0};
    for (int i = 0; i < 4; i++) {
        double d[3];
        sub3(d, f->vertex[(i + 1) % 4], f->vertex[i]);
        sides[i % 2] += length3(d) / 2;
    }
    *first = sides[0] >= sides[1] ? 0 : 1;
    return sides[*first];
}

static double area_of(const struct face *f)
{
    double vertex[4][3], n[3];
    memcpy(vertex, f->vertex, sizeof vertex);
    return polygon_normal(vertex, f->vertices, n);
}

/* Into how many parts, of a scene of so large an area in all. */
static uint32_t parts_of(const struct face *f, double whole)
{
    const double area = area_of(f);
    if (f->vertices != 4 || !(area > LONG_AREA * whole))
        return 1;
    int first;
    const double length = long_side(f, &first), ratio = length * length / area;
    return ratio < LONG_RATIO ? 1
                              : (uint32_t)fmax(1, fmin(0.5 * ratio, area / (LONG_PART * whole)));
}

/* The point i / n of the way from a to b. */
static void on_side(double p[3], const double a[3], const double b[3], uint32_t i, uint32_t n)
{
    for (int k = 0; k < 3; k++)
        p[k] = i == n ? b[k] : a[k] + (b[k] - a[k]) * ((double)i / n);
}

/* Part i of n, or of its far side, which stands behind f. */
static void part_of(const struct face *f, uint32_t i, uint32_t n, int back, struct face *part)
{
    *part = f[back];
    if (n == 1)
        return;
    int first;
    (void)long_side(f, &first);
    /* corners 0 and 1 are on the side that begins at `first`, 2 and 3 on the one across */
    for (uint32_t c = 0; c < 4; c++) {
        const int from = c < 2 ? first : (first + 3) % 4, to = c < 2 ? first + 1 : first + 2;
        on_side(part->vertex[back ? 3 - c : c], f->vertex[from], f->vertex[to % 4],
                i + (c == 1 || c == 2), n);
    }
}

int scene_shorten(struct scene *scene)
{
    double whole = 0;
    size_t most = 0;
    for (uint32_t i = 0; i < scene->face_count; i++)
        whole += area_of(&scene->faces[i]);
    for (uint32_t i = 0, sides; i < scene->face_count; i += sides) {
        sides = 1 + (uint32_t)scene_is_pair(scene, i);
        most += (size_t)sides * parts_of(&scene->faces[i], whole);
    }
    if (most == scene->face_count)
        return 0;
    struct face *faces = most <= UINT32_MAX ? malloc(most * sizeof *faces) : NULL;
    if (!faces)
        return -1;
    uint32_t count = 0;
    for (uint32_t i = 0, sides; i < scene->face_count; i += sides) {
        const uint32_t parts = parts_of(&scene->faces[i], whole);
        sides = 1 + (uint32_t)scene_is_pair(scene, i);
        scene->cut += parts > 1;
        scene->parts += parts > 1 ? parts : 0;
        for (uint32_t j = 0; j < parts; j++)
            for (int back = 0; back < (int)sides; back++)
                part_of(&scene->faces[i], j, parts, back, &faces[count++]);
    }
    free(scene->faces);
    scene->faces = faces;
    scene->face_count = count;
    return 0;
}
