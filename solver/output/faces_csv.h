/* faces_csv.h - the solution as a table, one row per face of the scene file.
 * SPDX-License-Identifier: MIT */
#ifndef FACES_CSV_H
#define FACES_CSV_H

#include "output/solution.h"

/* Columns: face (from 0, in the file's order), material, area (m2, one side), then exitance E,
 * reflectance rho, irradiance H and radiosity B per band, E_0, E_1, ... as area means over the
 * face's parts and, for a two-sided face, over both sides; 12 digits. A degenerate face that was
 * dropped has area 0 and zeros for the rest. Names are quoted as RFC 4180 says. measured: a
 * solution whose error was measured: columns err_k, B less the truth, and se_k, the standard error
 * of that, follow (W/m2); NULL: none. Returns 0, or -1 after one line on stderr. */
int faces_csv_write(const char *path, const struct solution *solution, RadSolution measured);

#endif
