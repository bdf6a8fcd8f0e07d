/* run_between.h - another program makes one file of another.
 *
 * Both are files, no pipes: none can fill up, and temporary ones without a name leave nothing
 * behind. No shell reads any word of it.
 * SPDX-License-Identifier: MIT */
#ifndef RUN_BETWEEN_H
#define RUN_BETWEEN_H

#include <stdio.h>

enum { RUN_NO_PROGRAM = 127 }; /* as a shell says it */

/* What was written to `from` is the standard input of words[0], looked for in PATH, from its
 * beginning; `to` is its standard output. words: to NULL. Returns its exit status, RUN_NO_PROGRAM,
 * or -1: it did not end by itself, or `from` could not be written. */
int run_between(const char *const words[], FILE *from, FILE *to);

#endif
