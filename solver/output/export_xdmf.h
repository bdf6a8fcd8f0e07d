/* export_xdmf.h - the leaves with all that is known of them, for ParaView and VisIt: .xdmf, a text
 * that says what stands where in a .h5 beside it.
 *
 * Cells are the leaves, as in .ply, corners that hang on their edges among theirs. Vertices have
 *     radiosity_K       B of band K as a picture shows it (W/m2)
 * and cells, each of one value:
 *     radiosity_mean_K  B, the mean over what of it no solid stands on (W/m2)
 *     irradiance_K      H, the mean over all of it (W/m2)
 *     error_K           of B, where it was measured and stands clear of noise (W/m2)
 *     area              m2; face, material: the polygon of the scene file, and its material
 * [XDMF 2, which VTK reads: XdmfReader]
 * SPDX-License-Identifier: MIT */
#ifndef EXPORT_XDMF_H
#define EXPORT_XDMF_H

#include "output/leaf_mesh.h"

/* error: [element * bands + band], NULL: not measured. Returns 0, or -1 after one line on stderr.
 * Both files appear whole or not at all, the .h5 first. Needs hdf5_built(). */
int export_xdmf(const char *path, const struct solution *solution, const struct leaf_mesh *mesh,
                const struct vertex_values *values, const double *error);

#endif
