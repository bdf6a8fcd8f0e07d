/* export_assimp.h - coloured meshes to the formats that Assimp writes.
 * SPDX-License-Identifier: MIT */
#ifndef EXPORT_ASSIMP_H
#define EXPORT_ASSIMP_H

#include "output/leaf_mesh.h"

/* Write polygons as `id`, one of Assimp's format names; colour[3 * vertex] is what the format
 * wants. z_up: the format has y up, and the scene z: turn it. Returns 0, or -1 after one line on
 * stderr. */
int export_assimp(const char *path, const char *id, int z_up, const struct leaf_mesh *mesh,
                  const struct vertex_values *values, const float *colour);

#endif
