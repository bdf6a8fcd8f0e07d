/* json_file.h - write a JSON value to a file that appears whole or not at all.
 * SPDX-License-Identifier: MIT */
#ifndef JSON_FILE_H
#define JSON_FILE_H

#include <jansson.h>

/* Takes over `value` (NULL: out of memory). `path` "-": standard output. Returns 0, or -1 after
 * a message. */
int json_file_write(const char *path, json_t *value);

#endif
