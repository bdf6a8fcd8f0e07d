/* text_file.h - a whole file in memory.
 * SPDX-License-Identifier: MIT */
#ifndef TEXT_FILE_H
#define TEXT_FILE_H

#include <stddef.h>
#include <string.h>

/* The bytes of `path` with a 0 behind them, or NULL with errno set; for free(). EFBIG: above 4 GB,
 * of a pipe 1 GB. */
char *text_file_read(const char *path, size_t *size);

/* The same, or NULL after a message. */
char *text_file_need(const char *path, size_t *size);

/* The same as the first, of a file that another file names: a pipe is none, for it could be waited
 * for for ever.
 */
char *text_file_read_regular(const char *path, size_t *size);

/* Bytes of the mark of UTF-8 that some editors begin a text with: 3, or 0. */
static inline size_t text_mark(const char *text)
{
    return strncmp(text, "\xEF\xBB\xBF", 3) == 0 ? 3 : 0;
}

#endif
