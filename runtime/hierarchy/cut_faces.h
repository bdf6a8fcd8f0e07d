/* cut_faces.h - cut faces where other faces stand in them.
 * SPDX-License-Identifier: MIT */
#ifndef CUT_FACES_H
#define CUT_FACES_H

#include "hierarchy/scene.h"

/* Cut the scene's faces in place, on so many threads, with a tree over them;
 * scene->cut and scene->parts say how many and into how many. Materials and areas of polygons stay.
 * Returns 0, or -1 when out of memory; then nothing has changed. A scene cut before is cut no
 * further where it was not left at the limit. */
int scene_cut(struct scene *scene, const struct bvh *tree, int threads);

#endif
