/* nastran_include.h - the file that INCLUDE names in Nastran bulk data.
 *
 * The name stands in quotes, in which it may go on on the next lines, or ends at a blank. It is
 * taken from the folder of the file that names it on, `\` as `/`.
 * [NX Nastran quick reference guide, INCLUDE]
 * SPDX-License-Identifier: MIT */
#ifndef NASTRAN_INCLUDE_H
#define NASTRAN_INCLUDE_H

#include <stddef.h>
#include <stdint.h>

struct nastran_include {
    char *path, *text; /* for free() */
    size_t size;
};

/* Is this line, up to `end`, an INCLUDE? Returns what is behind the word, NULL when it is none. */
const char *nastran_is_include(const char *line, const char *end);

/* Reads that file; `name` is what is behind the word, `*end` that line's end, which moves to where
 * the name ends. Returns 0, or -1 after a message; then there is nothing to free. */
int nastran_include(const char *path, uint32_t line, const char *name, const char **end,
                    const char *text_end, struct nastran_include *to);

#endif
