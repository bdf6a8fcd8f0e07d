/* read_scene.h - a scene file straight to a scene of the engine.
 * SPDX-License-Identifier: MIT */
#ifndef READ_SCENE_H
#define READ_SCENE_H

#include "hierarchy/scene.h"
#include "scene/scene_file.h"

/* Returns 0, or -1 after one line on stderr; then *scene is empty. */
int scene_read(struct scene *scene, const char *path, const struct scene_options *options);

#endif
