/* export_assimp.h - coloured meshes to the formats that Assimp writes.
 * SPDX-License-Identifier: MIT */
#ifndef EXPORT_ASSIMP_H
#define EXPORT_ASSIMP_H

#include "output/leaf_mesh.h"

/* Write polygons as `id`, one of Assimp's format names; colour[3 * vertex] is what the format
 * wants, the surfaces say of which materials they are. glTF has y up: a scene with z up is turned.
 * Returns 0, or -1 after one line on stderr. */
int export_assimp(const char *path, const char *id, const struct surfaces *surfaces,
                  const struct leaf_mesh *mesh, const struct vertex_values *values,
                  const float *colour);

#endif
