/* captured.h - what is written to a stream of the process while a test looks on.
 * SPDX-License-Identifier: MIT */
#ifndef CAPTURED_H
#define CAPTURED_H

#include <check.h>
#include <stdio.h>
#include <unistd.h>

struct captured {
    FILE *file;
    int stream, was;
};

/* From now on what is written to the stream, STDOUT_FILENO or STDERR_FILENO, is kept; until
 * capture_end, in which the stream is what it was. */
static inline struct captured capture_start(int stream)
{
    struct captured c = {.file = tmpfile(), .stream = stream};
    ck_assert_ptr_nonnull(c.file);
    fflush(NULL);
    c.was = dup(stream);
    ck_assert_int_eq(dup2(fileno(c.file), stream), stream);
    return c;
}

/* The first size - 1 bytes of it go to `text`. */
static inline void capture_end(struct captured *c, char *text, size_t size)
{
    fflush(NULL);
    dup2(c->was, c->stream);
    close(c->was);
    rewind(c->file);
    text[fread(text, 1, size - 1, c->file)] = '\0';
    (void)fclose(c->file);
}

#endif
