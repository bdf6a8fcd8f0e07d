/* read_assimp.h - scene files in the formats that Assimp reads.
 * SPDX-License-Identifier: MIT */
#ifndef READ_ASSIMP_H
#define READ_ASSIMP_H

#include "scene/scene_file.h"

/* Fill an empty file. Returns 0, or -1 after one line on stderr. */
int read_assimp(struct scene_file *file, const char *path);

#endif
