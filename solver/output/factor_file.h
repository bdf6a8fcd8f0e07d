/* factor_file.h - the matrix of view factors as a file.
 * SPDX-License-Identifier: MIT */
#ifndef FACTOR_FILE_H
#define FACTOR_FILE_H

#include "output/factor_table.h"

/* csv: a line of numbers per row. coo: a line `i,j,F` per entry that is not 0, from 0. mtx: Matrix
 * Market, coordinate real general, from 1. npz: what scipy.sparse.load_npz reads (factor_npz.h).
 * view3d: what View3D writes: a header, areas, rows, emissivities. energyplus: the object
 * ZoneProperty:UserViewFactors:BySurfaceName, every entry. openfoam: the lists F, entries that are
 * not 0, and beside it globalFaceFaces, their columns, and mapDist, which says that one process has
 * all faces. Texts with the 12 digits of %.12g, rows in the order of the scene file. */
enum factor_format {
    FACTOR_CSV,
    FACTOR_COO,
    FACTOR_MTX,
    FACTOR_NPZ,
    FACTOR_VIEW3D,
    FACTOR_ENERGYPLUS,
    FACTOR_OPENFOAM
};

/* What openfoam writes beside F. */
#define FACTOR_FACES "globalFaceFaces"
#define FACTOR_MAP "mapDist"

/* That of the file's ending, .mtx .npz .idf; csv for any other. */
enum factor_format factor_format_of(const char *path);

/* Has it no room for columns beside those of rows? */
int factor_format_square(enum factor_format format);

/* Files appear whole or not at all; `threads` write. Returns 0, or -1 after a message. */
int factor_file_write(const char *path, enum factor_format format, const struct factor_table *table,
                      int threads);

#endif
