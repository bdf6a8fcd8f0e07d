/* text_file.h - a whole file in memory.
 * SPDX-License-Identifier: MIT */
#ifndef TEXT_FILE_H
#define TEXT_FILE_H

#include <stddef.h>

/* The bytes of `path` with a 0 behind them, or NULL with errno set; for free(). */
char *text_file_read(const char *path, size_t *size);

#endif
