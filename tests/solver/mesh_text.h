/* mesh_text.h - meshes that a test writes, and what reading says of those that it must refuse.
 * SPDX-License-Identifier: MIT */
#ifndef MESH_TEXT_H
#define MESH_TEXT_H

#include <check.h>
#include <stdarg.h>
#include <stdio.h>

#include "captured.h"
#include "folder.h"
#include "scene/scene_file.h"

enum { TEXT = 1 << 16 };
static struct {
    char at[TEXT];
    size_t size;
} text;

__attribute__((__format__(__printf__, 1, 2))) static inline void put(const char *format, ...)
{
    va_list a;
    va_start(a, format);
    text.size += (size_t)vsnprintf(text.at + text.size, TEXT - text.size, format, a);
    va_end(a);
    ck_assert_uint_lt(text.size, TEXT);
}

static inline void write_text(const char *name)
{
    FILE *f = fopen(in_folder(name), "wb");
    ck_assert_ptr_nonnull(f);
    ck_assert_uint_eq(fwrite(text.at, 1, text.size, f), text.size);
    ck_assert_int_eq(fclose(f), 0);
}

static const struct scene_options quietly = {.quiet = 1};

/* What reading says on stderr, of a file of which that must be the result. */
static inline const char *said_of(const char *path, const struct scene_options *how, int wanted)
{
    static char said[1000];
    struct scene_file f;
    struct captured err = capture_start(STDERR_FILENO);
    const int result = scene_file_read(&f, path, how);
    capture_end(&err, said, sizeof said);
    ck_assert_msg(result == wanted, "%s: %s", path, result ? said : "is read");
    if (result == 0)
        scene_file_free(&f);
    return said;
}

static inline const char *refusal(const char *path)
{
    return said_of(path, &quietly, -1);
}

#define POLYDATA "# vtk DataFile Version 3.0\n\nASCII\nDATASET POLYDATA\n"

#endif
