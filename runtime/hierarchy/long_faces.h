/* long_faces.h - cut long faces across, so that elements of them are not long, too.
 * SPDX-License-Identifier: MIT */
#ifndef LONG_FACES_H
#define LONG_FACES_H

#include "hierarchy/scene.h"

/* Cut the scene's long faces in place, counted as by scene_cut; parts share their face's polygon.
 * Materials and areas of polygons stay. Returns 0, or -1 when out of memory; then nothing has
 * changed. */
int scene_shorten(struct scene *scene);

#endif
