/* lit_faces.h - the faces of a scene, with those sides told apart that no light comes to.
 * SPDX-License-Identifier: MIT */
#ifndef LIT_FACES_H
#define LIT_FACES_H

#include "hierarchy/scene.h"
#include "util/ranks.h"

/* Set scene->lit, where anything is dark, on so many threads of each rank. Returns 0, or -1 with
 * *cause set (a constant string). */
int lit_faces_find(struct scene *scene, struct ranks *ranks, int threads, const char **cause);

#endif
