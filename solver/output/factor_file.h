/* factor_file.h - the matrix of view factors as text.
 * SPDX-License-Identifier: MIT */
#ifndef FACTOR_FILE_H
#define FACTOR_FILE_H

#include "output/solution.h"

/* csv: a line of numbers per row. coo: a line `i,j,F` per entry that is not 0, from 0. mtx: Matrix
 * Market, coordinate real general, from 1. All with the 12 digits of %.12g, rows in the order of
 * the scene file. */
enum factor_format { FACTOR_CSV, FACTOR_COO, FACTOR_MTX };

/* Of a matrix of so many `polygons` the rows of the first `rows` are written, columns of their
 * copies summed onto theirs (util/fold.h); `threads` write. Returns 0, or -1 after a message. */
int factor_file_write(const char *path, enum factor_format format, RadExchange exchange,
                      uint32_t polygons, uint32_t rows, int threads);

/* A name per row: that of the polygon's material, and its number in the scene file from 0.
 * Returns 0, or -1 after a message. */
int factor_file_names(const char *path, const struct surfaces *surfaces);

#endif
