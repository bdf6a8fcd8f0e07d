/* read_meshes.h - formats of those who compute with meshes: Gmsh .msh, VTK, Nastran bulk data,
 * View3D .vs3.
 *
 * One polygon per element with a surface, in the file's order; of curved elements the corners. What
 * is named as a group (Gmsh: physical surface, Nastran: property, View3D: surface) is a material's
 * name. Elements that fill space are passed over and told, points and lines counted.
 * [Gmsh reference manual, MSH file format 2.2 and 4.1; VTK file formats; NX Nastran quick reference
 * guide, bulk data; Walton, View3D user manual 3.3]
 * SPDX-License-Identifier: MIT */
#ifndef READ_MESHES_H
#define READ_MESHES_H

#include "scene/scene_file.h"

/* Fill an empty file, whose size and text the caller has read; the text is changed. Warn unless
 * `quiet`. Each returns 0, or -1 after one line on stderr. */
int read_gmsh(struct scene_file *file, const char *path, char *text, size_t size, int quiet);
int read_vtk(struct scene_file *file, const char *path, char *text, size_t size, int quiet);
int read_vtk_xml(struct scene_file *file, const char *path, char *text, size_t size, int quiet);
int read_nastran(struct scene_file *file, const char *path, char *text, size_t size, int quiet);
int read_vs3(struct scene_file *file, const char *path, char *text, size_t size, int quiet);

#endif
