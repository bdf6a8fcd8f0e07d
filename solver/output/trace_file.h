/* trace_file.h - every discussion of a refinement, or those that a condition picks, one line each.
 *
 * A file that ends in .jsonl gets one JSON object per line, any other name CSV with a head line. It
 * appears whole or not at all, and takes TRACE_BYTES at the most: what comes later is counted, not
 * written.
 * SPDX-License-Identifier: MIT */
#ifndef TRACE_FILE_H
#define TRACE_FILE_H

#include <stdint.h>
#include "radiosity.h"

struct trace_file;

/* Open `path` ("-": standard output) and have the solution, whose oracle is interpreted, tell it of
 * every discussion for which `where` holds (NULL: of all). Returns 0, 2 after a message about the
 * condition, 1 after any other, -1 after an error of the solution's device. */
int trace_file_open(struct trace_file **trace, const char *path, const char *where, RadScene scene,
                    RadSolution solution, RadOracle oracle);

struct trace_count {
    uint64_t held, matched, written, bytes; /* discussions, those that matched, lines and bytes */
};

/* End of the trace; the file gets its name. Returns 0, or -1 after a message. */
int trace_file_close(struct trace_file *trace, struct trace_count *count);
/* Leave no trace. NULL is fine. */
void trace_file_discard(struct trace_file *trace);

#endif
