/* mesh.h - the runtime of mesh.dag: squares that tile the unit square, one of them to be discussed.
 * SPDX-License-Identifier: MIT */
#ifndef MESH_H
#define MESH_H

#include <math.h>

#define RUNTIME_ABI 1
#include "catalog.h"

#define GRID 512 /* cells to a side if all are split as deep as the catalog allows */

struct cell {
    double x, y, size; /* centre, side (m) */
    double u;          /* mean (K) */
};

struct mesh {
    int count;
    struct cell cells[GRID * GRID];
    int at[GRID][GRID]; /* row, column: the cell that covers this square of the grid */
};

struct discussion {
    struct terms terms;
    const struct mesh *mesh;
    int cell;
};

/* Sides are numbered left, right, lower, upper. The cell across half of one; -1: the boundary. */
int mesh_neighbour(const struct mesh *mesh, int cell, int side, int half);
/* The mean of u across a side, and how far from the cell's centre that holds (m). */
double mesh_across(const struct mesh *mesh, int cell, int side, double *distance);

#endif
