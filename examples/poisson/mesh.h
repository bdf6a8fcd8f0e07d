/* mesh.h - the runtime of mesh.dag: a quadtree over the unit square, and one cell of it to be
 * discussed.
 * SPDX-License-Identifier: MIT */
#ifndef MESH_H
#define MESH_H

#include <math.h>

#define RUNTIME_ABI 1
#include "catalog.h"

struct cell {
    double x, y, size; /* lower left corner, side (m) */
    double u;          /* mean (K) */
    double slope[2];   /* of u: along x, along y (K/m) */
    int depth, child;  /* the first of four; 0: a leaf */
};

struct mesh {
    struct cell *cells; /* the first is the square */
    int count;
};

struct discussion {
    struct terms terms;
    const struct mesh *mesh;
    int cell;
};

enum { SIDES = 8 }; /* halves of sides, two to each: left, right, lower, upper */

/* The leaf across half a side; -1: the boundary. */
int mesh_neighbour(const struct mesh *mesh, int cell, int side);
/* The mean of u across a side (0 to 3), and how far from the cell's centre that holds (m). */
double mesh_across(const struct mesh *mesh, int cell, int side, double *distance);

#endif
