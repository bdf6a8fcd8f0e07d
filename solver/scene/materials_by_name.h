/* materials_by_name.h - the materials of an OBJ file: what its libraries (MTL) define and what
 * usemtl means by a name.
 *
 * `mtllib` is state-setting, as every attribute of OBJ: a usemtl means the newest definition above
 * it, or the first one below when there is none above; faces keep what their usemtl meant, whatever
 * library comes later. Of several files on one mtllib line the first that has a name defines it.
 * Of MTL: newmtl, Kd, and Ke, which is W/m2 and not clamped.
 * [Wavefront Advanced Visualizer, appendix B1, Object Files; MTL material format, v4.2]
 * SPDX-License-Identifier: MIT */
#ifndef MATERIALS_BY_NAME_H
#define MATERIALS_BY_NAME_H

#include "scene/name_slots.h"
#include "scene/scene_file.h"

/* What a reader took for granted or passed over, each kind told once. */
enum assumption {
    NO_DIFFUSE,
    NO_MATERIAL,
    NO_DEFINITION,
    DEFINED_TWICE,
    STRAY_COLOUR,
    TEXTURE,
    TRANSPARENT,
    WEIGHT,
    UNKNOWN_LINE,
    ASSUMPTIONS
};

struct assumed {
    uint32_t count, line; /* how often, and the line of the first */
    char *file;           /* where the first is */
    char *name;           /* what it is about */
};

struct materials_by_name {
    struct scene_file *file;
    const char *path; /* of the OBJ file */
    /* [material_count]: the line of the first usemtl of each that no library has defined yet,
     * else 0 */
    uint32_t *use;
    size_t use_capacity;
    uint32_t *group; /* [material_count]: the mtllib line that defined it, counted from 1 */
    size_t group_capacity;
    struct name_slots newest; /* material of each name */
    uint32_t groups;          /* mtllib lines so far */
    uint32_t line;            /* of the last */
    uint32_t defined;         /* newmtl so far */
    char *last;               /* the library read last */
    struct assumed assumed[ASSUMPTIONS];
};

/* All return 0, or -1 after a message; materials_use the material's number through *material. */
int materials_library(struct materials_by_name *m, const char *line_text, uint32_t line);
int materials_use(struct materials_by_name *m, const char *name, uint32_t line, uint32_t *material);
int materials_stand_in(struct materials_by_name *m, uint32_t line, uint32_t *material);

/* The libraries of an mtllib line: one name, which may hold blanks, or several, with a comment
 * behind. Which is meant is told by what is there, so each is handed to `take`, which returns 0, -1
 * for an end, or 1 when there is no such file and it `may_miss`. Returns 0 or -1. */
typedef int library_fn(void *to, const char *name, size_t length, int may_miss);
int materials_libraries(const char *line_text, library_fn *take, void *to);

/* At the end of the file: is all defined that was used? */
int materials_check(struct materials_by_name *m);

/* Count an assumption. A name is copied to its end or to `end`. */
void materials_assume(struct materials_by_name *m, enum assumption kind, const char *file,
                      uint32_t line, const char *name, const char *end);
/* Tell them, a warning each. */
void materials_warn(const struct materials_by_name *m);
void materials_free(struct materials_by_name *m);

#endif
