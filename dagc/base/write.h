/* write.h - files that appear whole or not at all.
 * SPDX-License-Identifier: MIT */
#ifndef WRITE_H
#define WRITE_H

#include "base/internal.h"

/* One file to write: path NULL: none; "-": standard output. */
struct output {
    const char *path;
    struct text text;
    char *real; /* the path behind links, while writing */
    char *part; /* the temporary file beside it; NULL: write in place (a device or a pipe) */
};

/* Writes all outputs or, when one of them fails, none; says why on standard error. 0 or -1. */
int dag_write_outputs(struct output *outputs, int count);

/* Has what was printed to standard output arrived? Returns 0, or -1 after a message. */
int dag_write_ends(void);

#endif
