/* raster.h - which face does each sample of a picture see?
 *
 * A sample is inside a face when its ray passes all edges on the same side; that is a sign of a
 * linear function of the sample's place in the picture, and needs no clipping where a face
 * reaches behind the eye. Two faces with a common edge compute it from the same numbers with
 * opposite signs, so that no sample falls between them. [Olano & Greer 1997]
 * SPDX-License-Identifier: MIT */
#ifndef RASTER_H
#define RASTER_H

#include <stdint.h>
#include "output/view.h"

#define NO_FACE UINT32_MAX

/* Linear in the picture: value = c[0] + c[1] x + c[2] y, x and y in samples. */
struct raster_plane {
    double c[3];
};

struct raster_face {
    struct raster_plane edge[4]; /* >= 0 inside */
    struct raster_plane depth;   /* 1 / distance along the axis of view */
    int edges;
    int front; /* 1: the eye sees the front */
    uint32_t face;
    int left, right, top, bottom; /* samples that it may cover: [left, right) x [top, bottom) */
};

struct raster {
    int width, height; /* samples */
    double eye[3];
    /* direction of sample (x, y): corner + x step_x + y step_y */
    double corner[3], step_x[3], step_y[3];
    struct raster_face *faces; /* [count] */
    uint32_t count;
};

/* With `backs`, backs of one-sided faces are seen too. Returns 0, or -1 when out of memory. */
int raster_begin(struct raster *r, const struct surfaces *surfaces, const struct view *view,
                 int width, int height, int backs);

/* Fill face[(y - from) * width + x] with the face each sample of rows [from, to) sees, or NO_FACE,
 * and `nearness` with 1 / its distance along the axis of view. Allowed on many threads at once. */
void raster_rows(const struct raster *r, int from, int to, uint32_t *face, double *nearness);

/* The direction of the middle of sample (x, y); its component along the axis of view is 1. */
void raster_direction(const struct raster *r, double x, double y, double direction[3]);

/* Where the ray of sample (x, y) meets the plane of a face, and its direction. */
void raster_point(const struct raster *r, const struct solution *s, uint32_t face, double x,
                  double y, double direction[3], double point[3]);

void raster_end(struct raster *r);

#endif
