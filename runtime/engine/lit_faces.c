/* lit_faces.c - see lit_faces.h.
 *
 * The inside of a solid with two-sided faces is a surface that a tree would hold, links would reach
 * and particles would look for, and what little light they let in through the floor's leaves below
 * would stay there. So it is found first, by a tree and rays of its own; what is then solved has
 * solids with black backs, as scenes of one-sided faces have them.
 * SPDX-License-Identifier: MIT */
#include "engine/lit_faces.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "visibility/dark_sides.h"

static int has_far_sides(const struct scene *scene)
{
    for (uint32_t i = 0; i < scene->face_count; i++)
        if (scene->faces[i].back)
            return 1;
    return 0;
}

/* Of each face E in the band where it is largest. Returns whether any emits. */
static int find_brightest(const struct scene *scene, double *brightest)
{
    int any = 0;
    for (uint32_t i = 0; i < scene->face_count; i++) {
        const double *exitance = scene->materials[scene->faces[i].material].exitance;
        brightest[i] = fmax(exitance[0], fmax(exitance[1], exitance[2]));
        any |= brightest[i] > 0;
    }
    return any;
}

/* dark: [face_count]. Returns 0, or -1 with *cause set. */
static int find_dark(const struct scene *scene, const double *brightest, struct ranks *ranks,
                     int threads, uint8_t *dark, const char **cause)
{
    struct hierarchy h = {0};
    struct rays *rays = NULL;
    int result = -1;
    if (!ranks_any(ranks, hierarchy_build_by(&h, scene->faces, scene->face_count,
                                             CLUSTERING_DEFAULT, threads)
                              < 0))
        rays = rays_open(&h, brightest, brightest, threads, cause);
    if (!ranks_any(ranks, !rays)) {
        *cause = "out of memory";
        result = dark_sides_find(rays, &h, brightest, scene->precision, ranks, threads, dark);
    }
    rays_close(rays);
    hierarchy_free(&h);
    return result;
}

static void mark(struct face *faces, uint32_t count, const uint8_t *dark)
{
    for (uint32_t i = 0; i < count; i++) {
        if (!dark[i])
            continue;
        const uint32_t other = face_other_side(faces, count, i);
        faces[i].light = FACE_DARK;
        faces[i].black = 1;
        if (!dark[other])
            faces[other].light = FACE_ALONE;
    }
}

int lit_faces_find(struct scene *scene, struct ranks *ranks, int threads, const char **cause)
{
    if (!has_far_sides(scene))
        return 0;
    const size_t count = scene->face_count;
    double *brightest = malloc(count * sizeof *brightest);
    uint8_t *dark = calloc(count, 1);
    int result = -1;
    *cause = "out of memory";
    if (!ranks_any(ranks, !brightest || !dark))
        result = find_brightest(scene, brightest)
                     ? find_dark(scene, brightest, ranks, threads, dark, cause)
                     : 0;
    if (result == 0 && memchr(dark, 1, count)) {
        scene->lit = malloc(count * sizeof *scene->lit);
        result = ranks_any(ranks, !scene->lit) ? -1 : 0;
        if (result == 0) {
            memcpy(scene->lit, scene->faces, count * sizeof *scene->lit);
            mark(scene->lit, scene->face_count, dark);
        }
    }
    free(brightest);
    free(dark);
    return result;
}
