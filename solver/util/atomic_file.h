/* atomic_file.h - an output file that appears whole or not at all.
 *
 * Bytes go to a temporary file in the directory of the output, which takes the output's name
 * when it is complete. So a full disk, an error or a signal never leaves half a file under
 * the name that was asked for, nor destroys the file that was there.
 * SPDX-License-Identifier: MIT */
#ifndef ATOMIC_FILE_H
#define ATOMIC_FILE_H

#include <stdio.h>

struct atomic_file {
    FILE *stream;    /* write here; NULL when not open */
    char *path;      /* as the caller named it, for messages */
    char *target;    /* the file behind path, symbolic links resolved */
    char *buffer;    /* of the stream */
    char *temporary; /* NULL when path is a device or a pipe, which is written in place */
    int silent;      /* nothing is said of what goes wrong */
};

/* Could path be written now? Leaves no trace. To be asked before long work whose result goes there.
 * Returns 0, or -1 after one line on stderr. */
int atomic_check(const char *path);

/* Each returns 0, or -1 after one line on stderr; a failed file is discarded already. */
int atomic_open(struct atomic_file *file, const char *path);
int atomic_commit(struct atomic_file *file);

/* Whether all that was written to a stream has left its buffer: 0, or errno of why it has not, if
 * it was an earlier write, too. Errors of a stream that failed are cleared. */
int stream_flush(FILE *stream);

/* The same without a line, in the commit, too: of what has been told. */
int atomic_open_silently(struct atomic_file *file, const char *path);

/* Close without leaving a trace. Allowed on a file that is not open. */
void atomic_discard(struct atomic_file *file);

#endif
