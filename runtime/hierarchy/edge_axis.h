/* edge_axis.h - which faces touch an edge, along which stretches of it, and how they stand around
 * it.
 *
 * Edges need not be equal, nor those of faces at all: what is nearer than CUT_TOUCH is at one
 * place.
 * SPDX-License-Identifier: MIT */
#ifndef EDGE_AXIS_H
#define EDGE_AXIS_H

#include "hierarchy/hierarchy.h"
#include "kernel/hemisphere.h"

enum { EDGE_FACES = 64 }; /* that touch an edge; of more nothing is known */

/* An edge of a face, its smaller end first. */
struct edge {
    double end[2][3];
    uint32_t face;
};

/* A face as it stands around an edge, by its angle: half a plane. Sides look on towards larger
 * angles, and back. */
struct wing {
    double angle;
    uint32_t on, back;
    int whole; /* of a face that the edge runs through; its sides say nothing */
};

/* A stretch of an edge that a face touches, in lengths of the edge. */
struct stretch {
    double from, to;
    uint32_t face;
};

/* An edge as it is looked at; square to it are across.u and across.v. */
struct edge_axis {
    const struct hierarchy *h;
    const struct edge *edge; /* [shared]: of so many faces */
    size_t shared;
    struct hemisphere across;
    double along[3], length, touch; /* m; nearer than that is the same place */
    double low[3], high[3];         /* box of what is nearer than touch (m) */
};

/* For an edge that the `shared` from this one on are equal to; precision: of coordinates, relative
 * (scene.h). Returns 0 when the edge is a point. */
int edge_axis_of(struct edge_axis *x, const struct hierarchy *h, const struct edge *edge,
                 size_t shared, double precision);

/* The stretches of the edge that faces touch, far sides left out, at most EDGE_FACES of them.
 * Returns how many; EDGE_FACES: perhaps more. */
int edge_axis_touched(const struct edge_axis *x, struct stretch *list);

/* How a face stands around a point of the edge that it touches. Returns how many wings that makes:
 * 1, or 2 where the edge runs through it. */
int edge_axis_wings(const struct edge_axis *x, uint32_t face, const double p[3],
                    struct wing *wings);

/* From the edge into a face that has it for a border, square to it. */
void edge_axis_inwards(const struct edge_axis *x, uint32_t face, double direction[3]);

#endif
