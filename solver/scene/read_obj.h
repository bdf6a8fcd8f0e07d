/* read_obj.h - OBJ files and their MTL files.
 *
 * One polygon per `f` line, in the file's order and in double precision, whatever its object, group
 * or run of materials. Errors have the line and what is wrong with it. Of OBJ: v, f, usemtl and
 * mtllib; of MTL what materials_by_name.h says. Normals, smoothing and transparency (d, Tr) are
 * passed over; points and lines are counted; what would change the result (textures, surfaces that
 * are no polygons) is told.
 * [Wavefront Advanced Visualizer, appendix B1, Object Files; MTL material format, v4.2]
 * SPDX-License-Identifier: MIT */
#ifndef READ_OBJ_H
#define READ_OBJ_H

#include "scene/scene_file.h"

/* Fill an empty file, and tell what was assumed unless `quiet`. Returns 0, or -1 after one line on
 * stderr. */
int read_obj(struct scene_file *file, const char *path, int quiet);

#endif
