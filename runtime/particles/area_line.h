/* area_line.h - all surfaces that reflect, laid out along a line from 0 to 1: what is spread evenly
 * over the line is spread evenly over their area, and neighbours on the line are neighbours in the
 * scene.
 *
 * Faces come in the tree's order. Within a face the line runs in quarters of quarters [Morton 1966]
 * through the unit square, which surface_even_point lays on the face.
 * SPDX-License-Identifier: MIT */
#ifndef AREA_LINE_H
#define AREA_LINE_H

#include "particles/tracer.h"

struct area_line {
    uint32_t *face;  /* [count]: those that reflect in some band */
    double *until;   /* [count]: running sums of their areas (m2) */
    uint32_t *place; /* [faces]: of each among them; UINT32_MAX: not among them */
    uint32_t count;
    double area; /* m2 */
};

/* Returns 0, or -1 when out of memory. */
int area_line_open(struct area_line *line, const struct tracer *t);
void area_line_close(struct area_line *line);

/* The point at u in [0, 1): its face, and p just in front of it. There are faces. */
uint32_t area_line_point(const struct area_line *line, const struct tracer *t, double u,
                         double p[3]);

/* Where a point of a face stands on the line, to about 2^-26 of the face either way; or -1 where
 * the face does not reflect. */
double area_line_place(const struct area_line *line, const struct tracer *t, uint32_t face,
                       const double at[3]);

#endif
