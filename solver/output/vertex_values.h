/* vertex_values.h - radiosity at the corners of the leaves, such that interpolation has no seams.
 *
 * A solution is constant over each leaf. A picture wants it continuous: a corner takes the area
 * mean over the leaves that meet there in one plane and one material. A corner in the middle of a
 * larger neighbour's edge ("hanging") takes what the neighbour has there, the mean of the edge's
 * ends, so that both sides of the edge show the same. [Cohen & Wallace 1993, section 8.3]
 *
 * A hanging vertex may be given a value of its own afterwards. Then the neighbour is bent along
 * that edge: to the function between its corners is added what each edge has above the line between
 * its ends, fading towards the other edges. So both sides still show the same, and what is linear
 * at the vertices is linear everywhere. [Coons 1967] Where faces of one surface do not share whole
 * edges, as parts of a cut face, the leaf past whose edge a corner lies counts for its mean; there
 * the two sides agree at corners only as far as the solution is smooth.
 *
 * Where another face stands on the surface, light may jump: leaves on two sides of a wall share no
 * vertex along it, so that nothing shines under it and a box that stands on the floor darkens none
 * of it. Beyond the wall's end they do. A leaf that solids cover wholly counts with what it emits:
 * no light arrives there, whatever the solver keeps of it.
 *
 * Invariant: parts of a face are cut at exact midpoints (a + b) / 2, so that equal points are
 * equal bits and a hash finds them.
 * SPDX-License-Identifier: MIT */
#ifndef VERTEX_VALUES_H
#define VERTEX_VALUES_H

#include <stdint.h>
#include "output/solution.h"

#define NO_VERTEX UINT32_MAX

/* A point as a corner of leaves of one material and one plane, on one side of what stands there. */
struct shared_vertex {
    double position[3];
    double normal[3];
    uint32_t material;
    /* where in `contacts` the directions begin that part the surface here; the same on all sides */
    uint32_t contact;
    uint8_t contacts, sector; /* how many, and between which this vertex is (contact.h) */
    uint32_t next;            /* the next vertex in the same place of the table */
    /* while building: of a hanging vertex that has no value yet, the ends of its edge */
    uint32_t end[2];
};

struct vertex_values {
    uint32_t bands;
    uint32_t count;
    struct shared_vertex *vertices; /* [count] */
    double *value;                  /* B, W/m2: [vertex * bands + band] */
    double *weight;                 /* [vertex]: area of the leaves whose mean it is, m2 */
    uint32_t *corner;               /* [element * 4 + i]: the vertex of a leaf's corner i */
    uint32_t *middle; /* the same: what hangs in the middle of the edge from there, or NO_VERTEX */
    double (*contact)[3]; /* [contact_count]: directions in the surface at a vertex */
    uint32_t contact_count;
    size_t contact_capacity;
    struct passing {
        uint32_t leaf, vertex;
        /* [passing_count], by leaf: on whose edge a vertex of another face of the surface lies */
    } * passing;
    uint32_t passing_count;
    size_t passing_capacity;
    uint32_t *table, table_size; /* first vertex of each hash value; the size is a power of 2 */
};

/* Returns 0, or -1 when out of memory; then *v is empty. The solution is not kept. */
int vertex_values_build(struct vertex_values *v, const struct solution *solution);
void vertex_values_free(struct vertex_values *v);

/* The vertex in the middle of the edge from vertex a to vertex b of a leaf, which is left of it,
 * or NO_VERTEX. */
uint32_t vertex_values_middle(const struct vertex_values *v, uint32_t a, uint32_t b);

/* B interpolated at a point of a face: bilinear in quads, linear in triangles, but for what hangs
 * on their edges. Returns the leaf. */
uint32_t vertex_values_at(const struct vertex_values *v, const struct solution *solution,
                          uint32_t face, const double point[3], double *radiosity);

#endif
