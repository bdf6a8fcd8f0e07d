/* tune_scene.h - a scene that oracles are tuned on: what its faces truly radiate, and how far a
 * solution is from that.
 * SPDX-License-Identifier: MIT */
#ifndef TUNE_SCENE_H
#define TUNE_SCENE_H

#include "scene/open_scene.h"

struct tune_scene {
    struct open_scene scene;
    const char *name;  /* its file's, without folders and ending; borrowed */
    int name_length;   /* of it */
    double *radiosity; /* B, area means: [band * polygons + polygon], W/m2 */
    double reflected;  /* W, all bands */
    /* L1 over polygons that the reference itself is off by, a share of the reflected light */
    double noise;
    uint64_t particles;
};

/* Trace the reference by particles, whose standard error per face, mean by area, becomes `noise` of
 * the reflected light. Returns 0, 1 when the device's progress function has cancelled it, or -1
 * after a message; to be closed in any case. */
int tune_scene_trace(struct tune_scene *t, double noise);

/* L1 over polygons of what `solution` is off by, a share of the reflected light, less what the
 * reference's noise makes of it. Returns it, or NAN after a message. */
double tune_scene_error(const struct tune_scene *t, RadSolution solution);

/* Read a scene; nothing is traced yet. Returns 0, or -1 after a message, with nothing to close. */
int tune_scene_open(struct tune_scene *t, const char *path, const struct scene_options *options,
                    int threads);
void tune_scene_close(struct tune_scene *t);

#endif
