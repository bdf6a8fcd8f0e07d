/* open_scene.h - a scene file read and committed, for commands to solve.
 * SPDX-License-Identifier: MIT */
#ifndef OPEN_SCENE_H
#define OPEN_SCENE_H

#include "scene/scene_file.h"

struct open_scene {
    const char *path; /* borrowed */
    struct scene_file file;
    RadDevice device;
    RadScene scene;
    struct RadSceneReport report;
};

/* Returns 0, or -1 after a message, with nothing to close. `turned`: what to do of polygons that
 * look turned. */
int open_scene_by(struct open_scene *s, const char *path, const struct scene_options *options,
                  enum RadTurned turned, int threads);
static inline int open_scene(struct open_scene *s, const char *path,
                             const struct scene_options *options, int threads)
{
    return open_scene_by(s, path, options, RAD_TURNED_IGNORE, threads);
}
void close_scene(struct open_scene *s);

#endif
