/* gathering.h - what a picture shows, gathered once more from the solution: at each pixel, or at
 * the corners of the leaves that are seen.
 *
 * Leaves are as large as the exchange of light allows; a shadow that an eye would look for may lie
 * within one, and the light on each is known as well as its rays and particles allow, which differ
 * from one to the next. What a point gathers from all of them has neither. Per pixel, what is left
 * is noise, which rays make less. Corners, which are interpolated between, all gather by the same
 * directions: what noise there is changes slowly over a surface and is not seen as such.
 * SPDX-License-Identifier: MIT */
#ifndef GATHERING_H
#define GATHERING_H

#include "output/raster.h"
#include "output/vertex_values.h"
#include "util/progress.h"

struct gathering {
    const char *path; /* of the picture's file, which messages name */
    RadDevice device;
    RadSolution solved;
    struct progress *progress; /* NULL: nobody looks */
    int rays;                  /* per pixel; 0: at corners */
    int failed;                /* a message has been written */
};

/* Light that the samples of pixel rows [from, to) see, side x side of them in a pixel, face[sample]
 * being the face that each sees: light[sample * bands + band], W/m2. Samples of a pixel that see
 * one face share what they gather. Returns 0, or -1. */
int gathering_rows(struct gathering *g, const struct raster *r, const struct solution *solution,
                   int side, int from, int to, const uint32_t *face, double *light);

/* The light at the corners of the leaves that are marked, seen[element], and at what hangs on their
 * edges, into values: as exactly as a picture of so many pixels is worth. Returns 0, or -1. */
int gathering_corners(struct gathering *g, struct vertex_values *values,
                      const struct solution *solution, const uint8_t *seen, double pixels);

#endif
