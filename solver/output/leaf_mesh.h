/* leaf_mesh.h - the leaves of a solution as polygons with shared vertices.
 *
 * Vertices are those of vertex_values, by the same indices. Invariant: a vertex in the middle of a
 * polygon's edge is a corner of that polygon, and so is one of another face of the same surface; so
 * the mesh has no T-junction inside a face, nor between the parts of one that was cut.
 * SPDX-License-Identifier: MIT */
#ifndef LEAF_MESH_H
#define LEAF_MESH_H

#include "output/vertex_values.h"

struct leaf_mesh {
    /* vertex indices of all polygons, one after the other */
    uint32_t *corner, corners;
    size_t corner_capacity;
    /* polygon i is corner[start[i]] .. corner[start[i + 1] - 1] */
    uint32_t *start, polygons;
    size_t polygon_capacity;
    uint32_t *material, materials; /* of each polygon, of the scene's */
    size_t material_capacity;
};

/* Returns 0, or -1 when out of memory; then *m is empty. */
int leaf_mesh_build(struct leaf_mesh *m, const struct solution *solution,
                    const struct vertex_values *values);

/* Cut all polygons into triangles, without new vertices. Returns 0, or -1 when out of memory; then
 * *m is empty. */
int leaf_mesh_triangulate(struct leaf_mesh *m, const struct vertex_values *values);

void leaf_mesh_free(struct leaf_mesh *m);

#endif
