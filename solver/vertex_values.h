/* vertex_values.h - radiosity at the corners of the leaves, such that interpolation has no seams.
 *
 * A solution is constant over each leaf. A picture wants it continuous: a corner takes the area
 * mean over the leaves that meet there in one plane and one material. A corner in the middle of a
 * larger neighbour's edge ("hanging") takes what the neighbour has there, the mean of the edge's
 * ends, so that both sides of the edge show the same. [Cohen & Wallace 1993, section 8.3]
 *
 * Invariant: parts of a face are cut at exact midpoints (a + b) / 2, so that equal points are
 * equal bits and a hash finds them.
 * SPDX-License-Identifier: MIT */
#ifndef VERTEX_VALUES_H
#define VERTEX_VALUES_H

#include <stdint.h>
#include "solution.h"

#define NO_VERTEX UINT32_MAX

/* A point as a corner of leaves of one material and one plane. */
struct shared_vertex {
    double position[3];
    double normal[3];
    uint32_t material;
    uint32_t next; /* the next vertex in the same place of the table */
    uint32_t end[2]; /* while building: of a hanging vertex that has no value yet, the ends of its edge */
};

struct vertex_values {
    uint32_t bands;
    uint32_t count;
    struct shared_vertex *vertices; /* [count] */
    double *value;                  /* B, W/m2: [vertex * bands + band] */
    uint32_t *corner;               /* [element * 4 + i]: the vertex of a leaf's corner i */
    uint32_t *table, table_size;    /* first vertex of each hash value; the size is a power of 2 */
};

/* Returns 0, or -1 when out of memory; then *v is empty. The solution is not kept. */
int vertex_values_build(struct vertex_values *v, const struct solution *solution);
void vertex_values_free(struct vertex_values *v);

/* The vertex in the middle of the edge from vertex a to vertex b, or NO_VERTEX. */
uint32_t vertex_values_middle(const struct vertex_values *v, uint32_t a, uint32_t b);

/* B interpolated at a point of a face: bilinear in quads, linear in triangles. Returns the leaf. */
uint32_t vertex_values_at(const struct vertex_values *v, const struct hierarchy *h, uint32_t face,
                          const double point[3], double *radiosity);

#endif
