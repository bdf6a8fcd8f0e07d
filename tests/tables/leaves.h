/* leaves.h - a solved mesh as `radiosity solve -o FILE.ply` writes it, asked at points.
 *
 * It is what the user gets: radiosity at the leaves' corners, to be interpolated between them. Any
 * version of the command writes it, so that an older one can be judged by the same rule.
 * SPDX-License-Identifier: MIT */
#ifndef LEAVES_H
#define LEAVES_H

#include <stdint.h>

struct leaves {
    uint32_t vertices, polygons, bands;
    double *position;         /* [3 * vertices], m */
    double *value;            /* [bands * vertices]: B, W/m2 */
    uint32_t *corner, *start; /* polygon i: corner[start[i]] to corner[start[i + 1] - 1] */
    double (*normal)[3];      /* [polygons] */
    /* a grid over the box: polygons in voxel i are item[first[i]] to item[first[i + 1] - 1] */
    double low[3], size;
    uint32_t side[3], *first, *item;
};

/* Returns 0, or -1 after a message. */
int leaves_read(struct leaves *m, const char *path);
void leaves_free(struct leaves *m);

/* B at a point of the surface that looks along `normal`, to value[bands]. Returns 0, or -1: there
 * is no leaf. */
int leaves_at(const struct leaves *m, const double point[3], const double normal[3], double *value);

#endif
