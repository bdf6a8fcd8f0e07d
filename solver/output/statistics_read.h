/* statistics_read.h - a statistics file that `solve --statistics` wrote, read back.
 * SPDX-License-Identifier: MIT */
#ifndef STATISTICS_READ_H
#define STATISTICS_READ_H

#include <jansson.h>

/* The document, its schema (radiosity-statistics/1) and every field that graph_svg_write reads
 * checked; the caller's, json_decref frees it. NULL after a message with file, line and cause. */
json_t *statistics_read(const char *path);

#endif
