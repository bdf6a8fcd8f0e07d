/* statistics_file.h - the statistics of a graph as a table.
 * SPDX-License-Identifier: MIT */
#ifndef STATISTICS_FILE_H
#define STATISTICS_FILE_H

#include "radiosity.h"

/* Write what the oracle has counted (radCountOracle) to `path`: text, or CSV or JSON by the name's
 * end; "-" is standard output, as text. Returns 0, or -1 after a message. */
int statistics_write(const char *path, const char *scene, RadOracle oracle);

#endif
