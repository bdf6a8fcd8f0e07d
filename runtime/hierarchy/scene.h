/* scene.h - a scene as the solver wants it: flat faces with reflectance and exitance.
 * SPDX-License-Identifier: MIT */
#ifndef SCENE_H
#define SCENE_H

#include <stdint.h>
#include "hierarchy/hierarchy.h"

struct material {
    char *name;
    double reflectance[3]; /* rho per band, 0 <= rho < 1 */
    double exitance[3];    /* E per band, W/m2, 0 <= E */
    int two_sided;
};

/* What the file held for one face, in the file's order; dropped faces stay in this list. */
struct input_face {
    uint32_t material;
    double area; /* m2, one side; 0 when the face was degenerate and dropped */
};

struct scene {
    struct face *faces; /* [face_count]: non-planar quads are two faces, cut ones several, two-sided ones two (front, then `back`) */
    uint32_t face_count;
    struct material *materials;
    uint32_t material_count;
    struct input_face *inputs; /* [input_count] */
    uint32_t input_count;
    uint32_t bands;   /* 1 when every material that is used is grey, else 3 */
    uint32_t dropped; /* degenerate faces */
    uint32_t cut;     /* faces cut where others stand in them (scene_cut.h), far sides not counted */
    uint32_t parts;   /* into so many, which share their face's input */
};

struct scene_options {
    int two_sided; /* treat every face as two-sided */
    int quiet;     /* no warnings on stderr */
};

/* Read `path` in any format that Assimp reads. On failure writes one line
 * "path[:line]: error: cause; how to mend it" to stderr and returns -1; then *scene is empty. */
int scene_read(struct scene *scene, const char *path, const struct scene_options *options);
void scene_free(struct scene *scene);

#endif
