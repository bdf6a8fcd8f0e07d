/* cells.h - the polygons of a scene cut into cells of about one area, to judge light point by
 * point: a reference traced for each cell is what a solution is held against.
 *
 * Invariant: the cells of a polygon tile it and keep its plane and its front; the same scene and
 * area give the same cells, in the file's order.
 * SPDX-License-Identifier: MIT */
#ifndef CELLS_H
#define CELLS_H

#include <stddef.h>
#include <stdint.h>
#include "scene/scene_file.h"

struct cell {
    double corner[4][3]; /* m, counter-clockwise from the front */
    uint32_t corners;    /* 3 or 4; 0: a polygon that is not cut, being concave, bent or larger */
    uint32_t polygon;    /* of the scene file */
};

struct cells {
    struct cell *cell; /* [count] */
    uint32_t count;
    size_t capacity;
};

/* Cut quads into n x m cells and triangles into n^2 like ones, such that each has about `share` of
 * the scene's area, which goes to *area (m2). Returns 0, or -1 when out of memory. */
int cells_cut(struct cells *cells, const struct scene_file *file, double share, double *area);
void cells_free(struct cells *cells);

/* The scene with its cells for polygons, to `path`.obj and `path`.mtl. Returns 0, or -1 after a
 * message. */
int cells_write(const struct cells *cells, const struct scene_file *file, const char *path);

#endif
