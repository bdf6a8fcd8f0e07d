/* scene_file.h - a scene file as arrays: the polygons and materials that radSetSceneSharedPolygons
 * and radSetSceneMaterials take, and what messages and tables want to know besides.
 *
 * Material: reflectance = diffuse colour (glTF: base colour), exitance in W/m2 = emissive colour
 * times its strength where the format has one. A face reflects and emits on both sides when its
 * material's name ends in "_2s", when the format says so (glTF: doubleSided), or when the caller
 * asks for it. Textures are not looked at.
 * SPDX-License-Identifier: MIT */
#ifndef SCENE_FILE_H
#define SCENE_FILE_H

#include <stddef.h>
#include <stdint.h>
#include "radiosity.h"
#include "scene/part_names.h"

/* Where a material file speaks of a material; line 0: it does not, or the format has no lines. */
struct material_place {
    char *file; /* NULL: the scene file itself */
    uint32_t diffuse_line, emissive_line;
};

struct scene_file {
    double *positions; /* [position_count * 3], m */
    size_t position_count, position_capacity;
    uint32_t *indices; /* [sum of sizes] */
    size_t index_count, index_capacity;
    /* [polygon_count], in the file's order; some may have fewer than three corners */
    uint32_t *sizes;
    uint32_t *polygon_materials; /* [polygon_count] */
    /* [polygon_count]: where each stands in the file; 0 where the format has no lines */
    uint32_t *lines;
    uint32_t polygon_count;
    size_t polygon_capacity;
    struct RadMaterial *materials; /* [material_count] */
    char **names;                  /* [material_count] */
    struct material_place *places; /* [material_count] */
    uint32_t material_count;
    size_t material_capacity;
    /* OBJ: g and o; STL: solids, as both; what Assimp reads: meshes and nodes */
    struct part_names groups, objects;
    /* 1: positions have been floats, as Assimp keeps them; numbers of a text may say more */
    int single_precision;
    uint32_t other;  /* points and lines of the file, which are no faces */
    uint32_t lights; /* that are no faces either, as points and suns; what Assimp reads */
};

struct scene_options {
    int two_sided; /* treat every face as two-sided */
    int quiet;     /* no warnings on stderr */
    /* for view factors: long faces are not cut across (RadPolygons.cut_long), and what reflects all
     * light, as glTF's white does, is as good as what reflects nearly all */
    int factors_alone;
};

/* Read `path`: OBJ, PLY, STL, OFF and meshes (read_meshes.h) by our readers, any other format by
 * Assimp. On failure writes one line "path[:line]: error: cause; how to mend it" to stderr and
 * returns -1; then *file is empty. */
int scene_file_read(struct scene_file *file, const char *path, const struct scene_options *options);
void scene_file_free(struct scene_file *file);
/* Corners are a tenth of what a large scene takes, and once it is committed nobody's need. */
void scene_file_forget_places(struct scene_file *file);

/* The polygons, for radSetSceneSharedPolygons; good until the file is freed. */
struct RadPolygons scene_file_polygons(const struct scene_file *file);

/* Say on stderr which faces lie on others, cross themselves or look turned, how many have been
 * dropped, and how many points and lines ignored; nothing when there are none. */
void scene_file_warn(const struct scene_file *file, const char *path,
                     const struct RadSceneReport *report, enum RadTurned turned);

/* Refuse a file of floats so far from the origin that rounding has left most of its faces without
 * area. Returns 0, or -1 after a message. */
int scene_file_check_rounding(const struct scene_file *file, const char *path,
                              const struct RadSceneReport *report);

/* For the readers of formats. Each returns 0, or -1 when out of memory. A polygon has the corners
 * added since the last one; a material's name is copied. */
int scene_file_add_position(struct scene_file *file, const double position[3]);
int scene_file_add_corner(struct scene_file *file, uint32_t position);
int scene_file_add_polygon(struct scene_file *file, uint32_t size, uint32_t material,
                           uint32_t line);
int scene_file_add_material(struct scene_file *file, const char *name,
                            const struct RadMaterial *material);

/* The polygons to come are of the group or object of that name, of so many bytes. */
int scene_file_use_group(struct scene_file *file, const char *name, size_t length);
int scene_file_use_object(struct scene_file *file, const char *name, size_t length);

/* What they say of that. Returns -1. */
int scene_file_no_memory(const char *path);

#endif
