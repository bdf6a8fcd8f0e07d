/* vtk_cells.h - cells of VTK files, whatever the file's form: what kind each is, which of its
 * points are corners.
 *
 * Points are counted from 0 in the piece that the cells are of. Triangles, quads, polygons, pixels
 * and strips are faces, curved ones by their corners; each triangle of a strip is a face.
 * [VTK file formats; vtkCellType.h]
 * SPDX-License-Identifier: MIT */
#ifndef VTK_CELLS_H
#define VTK_CELLS_H

#include "scene/mesh_parts.h"

enum { VTK_STRIP = 6, VTK_POLYGON = 7 };

/* Where the points of a piece begin among the file's positions, and how many they are. */
struct vtk_points {
    size_t first, count;
};

/* Says that an offset, of a cell's end among the `points` of all, is none. Returns -1. */
int vtk_wrong_offset(const struct mesh *m, double offset, size_t points, uint32_t line);
/* Says that types and cells are not as many. Returns -1. */
int vtk_wrong_types(const struct mesh *m, size_t types, size_t cells, uint32_t line);

/* A cell of `size` points, on a line of the file. Returns 0, or -1 after a message. */
int vtk_cell(struct mesh *m, struct vtk_points points, double type, const double *point,
             size_t size, uint32_t line);

#endif
