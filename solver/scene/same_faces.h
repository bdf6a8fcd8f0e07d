/* same_faces.h - faces of a file that have the corners of another.
 *
 * Two faces in one place would both receive what falls there, and power would be made. The first of
 * the file stays, whatever the materials. Faces back to back are a thin wall with two sides and
 * stay both, unless one of them is two-sided.
 * SPDX-License-Identifier: MIT */
#ifndef SAME_FACES_H
#define SAME_FACES_H

#include "scene/scene_file.h"

/* Leave of each such face a point, which has no area, so that all keep their numbers. Warn unless
 * `quiet`. Returns 0, or -1 after a message. */
int drop_same_faces(struct scene_file *file, const char *path, int quiet);

#endif
