/* stability_mesh.c - cases about faces that are not what they should be, as scene files have them.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "scene/make_scene.h"
#include "scene/read_scene.h"
#include "hierarchy/polygon.h"
#include "study/stability.h"

/* Read an OBJ text as a scene, from a folder that is gone when this returns. Returns 0 or -1. */
static int read_text(struct scene *scene, const char *obj)
{
    static const char materials[] = "newmtl grey\nKd .6 .6 .6\nKe 0 0 0\nnewmtl lamp\nKd 0 0 0\nKe 10 10 10\n";
    const char *temporary = getenv("TMPDIR");
    const struct scene_options quiet = { 0, 1 };
    char folder[512], path[2][640];
    const char *const text[2] = { obj, materials };
    int i, status = 0;
    snprintf(folder, sizeof folder, "%s/radiosity-XXXXXX", temporary && *temporary ? temporary : "/tmp");
    if (!mkdtemp(folder))
        return -1;
    for (i = 0; i < 2; i++) {
        FILE *file;
        snprintf(path[i], sizeof path[i], "%s/%s", folder, i ? "scene.mtl" : "scene.obj");
        file = fopen(path[i], "w");
        if (!file || fputs(text[i], file) < 0)
            status = -1;
        if (file && fclose(file) != 0)
            status = -1;
    }
    if (status == 0)
        status = scene_read(scene, path[0], &quiet);
    for (i = 0; i < 2; i++)
        unlink(path[i]);
    rmdir(folder);
    return status;
}

/* A lamp above a grey floor; between them and beside the lamp what the text adds, from vertex 9 on. */
#define LAMP_AND_FLOOR "mtllib scene.mtl\nv 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv .5 .5 2\nv .5 1.5 2\nv 1.5 1.5 2\nv 1.5 .5 2\n" \
                       "usemtl lamp\nf 5 6 7 8\nusemtl grey\nf 1 2 3 4\n"

/* The largest relative difference of B over the first `count` faces; with `exact`, INFINITY where a bit differs. */
static int difference(struct stability_trial *trial, const struct scene *one, const struct scene *other, uint32_t count, int exact, double *error)
{
    struct solve a, b;
    uint32_t i;
    int status = -1;
    if (stability_solve(&a, one, trial, 0) < 0)
        return -1;
    if (stability_solve(&b, other, trial, 0) == 0) {
        *error = exact && !stability_same_links(&a, &b) ? INFINITY : 0;
        for (i = 0; i < count; i++) {
            double x = stability_radiosity(&a, i), y = stability_radiosity(&b, i);
            *error = fmax(*error, isnan(y) ? INFINITY : x == y ? 0 : exact ? INFINITY : fabs(y / x - 1));
        }
        trial->count = (double)b.refinement.link_count;
        status = 0;
        solve_close(&b);
    }
    solve_close(&a);
    return status;
}

/* A trial of the default oracle, for rules that replace the reader and not the oracle. */
static struct stability_trial by_default(const struct stability_trial *trial)
{
    struct stability_trial t = *trial;
    if (t.method->kind != BY_ORACLE)
        t.method = &stability_methods[DEFAULT];
    return t;
}

/* A quad with one corner lifted by .6, beside its two triangles. */
int stability_bent_quad(struct stability_trial *trial)
{
    static const char corners[] = "v 0 0 1\nv 1 0 .4\nv 1 1 1\nv 0 1 .4\n";
    struct stability_trial with = by_default(trial);
    double corner[4][3] = { { 0, 0, 1 }, { 1, 0, 0.4 }, { 1, 1, 1 }, { 0, 1, 0.4 } };
    uint32_t triangle[2][3], scratch[4];
    char text[2][512];
    struct scene split, bent;
    int status;
    if (polygon_triangulate(corner, 4, triangle, scratch) != 2)
        return -1;
    snprintf(text[0], sizeof text[0], LAMP_AND_FLOOR "%sf %u %u %u\nf %u %u %u\n", corners, triangle[0][0] + 9, triangle[0][1] + 9,
             triangle[0][2] + 9, triangle[1][0] + 9, triangle[1][1] + 9, triangle[1][2] + 9);
    snprintf(text[1], sizeof text[1], LAMP_AND_FLOOR "%sf 9 10 11 12\n", corners);
    if (read_text(&split, text[0]) < 0)
        return -1;
    if (trial->method == &stability_methods[ONE_PLANE]) {
        bent = split;
        memcpy(split.faces[2].vertex, corner, sizeof corner);
        split.faces[2].vertices = 4;
        split.face_count = 3;
        status = difference(&with, &bent, &split, 2, 0, &trial->error); /* the solver is given four corners and believes */
        scene_free(&split);
        return status;
    }
    if (read_text(&bent, text[1]) < 0) {
        scene_free(&split);
        return -1;
    }
    status = difference(&with, &split, &bent, split.face_count, 1, &trial->error);
    trial->count = with.count;
    scene_free(&split);
    scene_free(&bent);
    return status;
}

/* A triangle on a line, and one with two corners in one place, among good faces. */
int stability_no_area(struct stability_trial *trial)
{
    static const char clean[] = LAMP_AND_FLOOR "v 0 0 1\nv 1 0 1\nv 1 1 1\nf 9 10 11\n";
    static const char dirty[] = LAMP_AND_FLOOR "v 0 0 1\nv 1 0 1\nv 1 1 1\nv .5 0 1\nv .25 0 1\nf 9 12 13\nf 9 9 10\nf 9 10 11\n";
    struct stability_trial with = by_default(trial);
    struct scene one, other;
    int status;
    if (read_text(&one, clean) < 0)
        return -1;
    if (read_text(&other, dirty) < 0) {
        scene_free(&one);
        return -1;
    }
    status = difference(&with, &one, &other, one.face_count, 1, &trial->error);
    if (status == 0 && (other.dropped != 2 || other.face_count != one.face_count))
        trial->error = INFINITY;
    trial->count = with.count;
    scene_free(&one);
    scene_free(&other);
    return status;
}
