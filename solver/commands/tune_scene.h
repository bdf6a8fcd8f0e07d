/* tune_scene.h - a scene that oracles are tuned on, and how far a solution is from what it truly
 * radiates.
 * SPDX-License-Identifier: MIT */
#ifndef TUNE_SCENE_H
#define TUNE_SCENE_H

#include "scene/open_scene.h"

struct tune_scene {
    struct open_scene scene;
    const char *name; /* its file's, without folders and ending; borrowed */
    int name_length;  /* of it */
    RadReference reference;
    uint64_t particles; /* of the reference */
    double uncertain;   /* half the 95 % interval of the error that it was traced for, a share */
};

/* Read a scene; nothing is traced yet. Returns 0, or -1 after a message, with nothing to close. */
int tune_scene_open(struct tune_scene *t, const char *path, const struct scene_options *options,
                    int threads);
void tune_scene_close(struct tune_scene *t);

/* L1 over polygons of what a solution is off by, a share of the reflected light. Of the first one,
 * particles are traced until that is known to a fifth of itself, or of `target` where that is more;
 * all others are held against the same particles. Returns 0, 1 when the device's progress
 * function has cancelled it, -1 after a message. */
int tune_scene_error(struct tune_scene *t, RadSolution solution, double target, double *error);

#endif
