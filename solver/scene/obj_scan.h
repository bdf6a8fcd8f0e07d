/* obj_scan.h - a first look at an OBJ file and its MTL files, for what Assimp does not tell.
 *
 * Assimp drops a bad line with a note in its log, and gathers faces by object and group, so that
 * neither the place of an error nor the order of the faces survives. The scan finds the errors
 * with their lines, and leaves a text in which only vertices, faces and materials remain; read
 * from that, Assimp's faces come in the file's order.
 * [Wavefront Advanced Visualizer, appendix B1, Object Files]
 * SPDX-License-Identifier: MIT */
#ifndef OBJ_SCAN_H
#define OBJ_SCAN_H

#include <stddef.h>
#include <stdint.h>

/* Where an MTL file speaks of a material; line 0: it does not. */
struct obj_material {
    char *name, *file;
    uint32_t line, diffuse_line, emissive_line;
};

struct obj_scan {
    char *text; /* what Assimp shall read, as long as the file */
    size_t size;
    struct obj_material *materials;
    uint32_t material_count, material_capacity;
    uint32_t faces;      /* `f` lines */
    uint32_t face_lines_capacity;
    uint32_t *face_line; /* [faces]: the line of each */
    uint32_t other;      /* points and lines, which are no faces */
};

/* Returns 0, or -1 after one error line; then *scan is empty. */
int obj_scan_read(struct obj_scan *scan, const char *path);
void obj_scan_free(struct obj_scan *scan);
void obj_scan_free_text(struct obj_scan *scan); /* all else stays */

const struct obj_material *obj_scan_material(const struct obj_scan *scan, const char *name);

#endif
