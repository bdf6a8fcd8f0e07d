/* factor_npz.h - the matrix of view factors as SciPy keeps sparse ones.
 *
 * A zip archive of arrays as NumPy writes them: data, indices, indptr, shape and format, which is
 * csr, for scipy.sparse.load_npz; besides names (bytes, UTF-8) and areas of rows, which numpy.load
 * gives. All entries that are not 0, in double.
 * [SciPy, scipy.sparse.save_npz; NumPy, numpy.lib.format, version 1.0]
 * SPDX-License-Identifier: MIT */
#ifndef FACTOR_NPZ_H
#define FACTOR_NPZ_H

#include "output/factor_table.h"

/* Returns 0, or -1 after a message. */
int factor_npz_write(const char *path, const struct factor_table *table, int threads);

#endif
