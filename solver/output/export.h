/* export.h - the solution's mesh for other programs: .ply, .gltf, .glb, .obj, .xdmf.
 *
 * One polygon per leaf, corners shared where values are; corners that hang on a larger neighbour's
 * edge are inserted there, so that no program shows cracks. Colours are the radiosity as a picture
 * would show it (exposed). In .ply each vertex has
 *     float x y z, uchar red green blue (sRGB), float radiosity_0 [radiosity_1 radiosity_2] (W/m2)
 * in binary, little endian. glTF holds linear colours (COLOR_0) and an unlit material, so that
 * viewers show the radiosity and nothing else, with y up as glTF wants it; .obj holds sRGB colours
 * behind the coordinates of each vertex, as MeshLab and Blender read them. .gltf comes with a .bin
 * and .obj with a .mtl, .xdmf with a .h5 (export_xdmf.h). Read as scenes, .obj and glTF have the
 * materials of the scene solved: Kd and Ke of MTL, and in glTF, whose materials say how to show it,
 * in the materials' names (util/material_name.h).
 *
 * Where single precision would bend the mesh (far_away.h), x y z of .ply are double, the node of
 * glTF moves coordinates about the mesh's middle to their place, and of .obj there is a warning.
 * SPDX-License-Identifier: MIT */
#ifndef EXPORT_H
#define EXPORT_H

#include "output/vertex_values.h"

enum export_format {
    EXPORT_UNKNOWN = -1,
    EXPORT_PLY,
    EXPORT_GLTF,
    EXPORT_GLB,
    EXPORT_OBJ,
    EXPORT_XDMF
};

/* The format that the name's extension asks for, in any case of letters. */
enum export_format export_format(const char *path);

/* error: [element * bands + band] of B, for .xdmf; NULL: not measured. Returns 0, or -1 after one
 * line on stderr. Files appear whole or not at all. */
int export_write(const char *path, const struct solution *solution,
                 const struct vertex_values *values, const double *error);

#endif
