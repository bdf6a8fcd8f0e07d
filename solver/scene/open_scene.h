/* open_scene.h - a scene file read and committed, for commands to solve.
 * SPDX-License-Identifier: MIT */
#ifndef OPEN_SCENE_H
#define OPEN_SCENE_H

#include "scene/copies.h"

struct open_scene {
    const char *path; /* borrowed */
    struct scene_file file;
    RadDevice device;
    RadScene scene;
    struct RadSceneReport report;
    uint32_t originals; /* polygons of the file; with copies, fewer than the scene's */
};

/* With the copies that make it whole (NULL: none); `turned`: what to do of polygons that look
 * turned. Returns 0, or -1 after a message, with nothing to close. */
int open_whole_scene(struct open_scene *s, const char *path, const struct scene_options *options,
                     const struct copies *copies, enum RadTurned turned, int threads);
static inline int open_scene(struct open_scene *s, const char *path,
                             const struct scene_options *options, int threads)
{
    return open_whole_scene(s, path, options, NULL, RAD_TURNED_IGNORE, threads);
}
void close_scene(struct open_scene *s);

#endif
