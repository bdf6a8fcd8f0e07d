/* picture.h - a scene seen through a camera, coloured by whatever one wants to see.
 *
 * The image of the light and that of its error are the same picture in other colours: same camera,
 * same samples, same lines of the mesh; pixel by pixel one can be laid over the other.
 * SPDX-License-Identifier: MIT */
#ifndef PICTURE_H
#define PICTURE_H

#include "output/exposure.h"
#include "output/gathering.h"
#include "output/vertex_values.h"
#include "output/view.h"

struct picture {
    const char *path; /* of the file it is for, which messages name */
    const struct solution *solution;
    const struct vertex_values *values;
    struct view view;
    int width, height, mesh;     /* pixels; mesh: the edges of the leaves over it */
    struct exposure exposure;    /* for what the picture shows of the light */
    struct gathering *gathering; /* NULL: light is interpolated between corners */
};

/* What one sample sees. */
struct picture_sample {
    uint32_t leaf;
    const double *radiosity; /* there, [bands], W/m2 */
    double x, y;             /* where it stands in the picture, pixels from the top left */
};

/* The colour of a sample, linear, each channel 0 to 1. Asked on many threads at once. */
typedef void (*picture_colour)(const void *context, const struct picture_sample *sample,
                               double colour[3]);

/* Says that there is no memory for a picture. Returns -1. */
int picture_no_memory(const char *path);

/* View NULL: one is guessed. Backs of one-sided faces are cut away, so that one can look into a
 * closed room from outside. Nothing is copied. Returns 0, or -1 after one line on stderr. */
int picture_open(struct picture *p, const char *path, const struct solution *solution,
                 const struct vertex_values *values, const struct view *view, int width, int height,
                 int mesh);

/* Mark the leaves that are seen in the middle of pixels: seen[element]. Returns 0, or -1 after one
 * line on stderr. */
int picture_seen(const struct picture *p, uint8_t *seen);

/* The pixels, sRGB, from the top left, [height * width * 3]; the caller frees them. NULL after one
 * line on stderr. Colours are averaged over nine samples a pixel. */
uint8_t *picture_draw(const struct picture *p, picture_colour colour, const void *context);

#endif
