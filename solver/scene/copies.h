/* copies.h - planes of symmetry and periods: a part of a scene that stands for the whole.
 *
 * The whole is made: a plane adds the image of all there is so far, a period adds that many copies
 * on either side. Polygon i of the k-th copy becomes polygon k * originals + i, so that what is
 * said of copies can be summed onto the originals (util/fold.h).
 * SPDX-License-Identifier: MIT */
#ifndef COPIES_H
#define COPIES_H

#include "scene/scene_file.h"

enum { COPY_STEPS = 8 };

struct copy_step {
    int axis;  /* 0 to 2 */
    int times; /* copies on either side; 0: a mirror */
    double at; /* the mirror's place, or the period (m) */
};

struct copies {
    int count;
    struct copy_step steps[COPY_STEPS];
};

/* Add the copies to what `path` holds. Returns 0, or -1 after a message: a face crosses or lies in
 * a mirror, or the scene is longer than its period. */
int copies_add(struct scene_file *file, const char *path, const struct copies *copies);

#endif
