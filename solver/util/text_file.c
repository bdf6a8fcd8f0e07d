/* text_file.c - see text_file.h.
 * SPDX-License-Identifier: MIT */
#include "util/text_file.h"

#include <errno.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

#include "util/array.h"
#include "util/report.h"

/* What is read of a pipe (bytes), which may have no end; chosen. */
static const size_t PIPE_MOST = (size_t)1 << 30;
/* And of a file, which may be damaged or sparse: 50 million faces of an OBJ file take as much. */
static const uint64_t FILE_MOST = (uint64_t)1 << 32;

char *text_file_read(const char *path, size_t *size)
{
    FILE *stream = fopen(path, "rb");
    if (!stream)
        return NULL;
    struct stat status;
    int cause = fstat(fileno(stream), &status) ? errno
                : S_ISDIR(status.st_mode)      ? EISDIR
                : S_ISCHR(status.st_mode)      ? ENOTSUP /* /dev/zero has no end */
                : S_ISREG(status.st_mode) && (uint64_t)status.st_size > FILE_MOST ? EFBIG
                                                                                  : 0;
    if (cause) {
        fclose(stream);
        errno = cause;
        return NULL;
    }
    const size_t most = S_ISREG(status.st_mode) ? SIZE_MAX : PIPE_MOST;
    /* Grown while reading: a pipe has no size to ask for. */
    size_t capacity = 0, used = 0, need = (size_t)(status.st_size > 0 ? status.st_size : 0) + 2;
    char *text = NULL;
    do {
        cause = used >= most ? EFBIG : array_reserve(&text, need, &capacity, 1) < 0 ? ENOMEM : 0;
        if (cause)
            break;
        used += fread(text + used, 1, capacity - used - 1, stream);
        need = capacity + 1;
    } while (used == capacity - 1);
    if (!cause && ferror(stream))
        cause = EIO;
    fclose(stream);
    if (cause) {
        free(text);
        errno = cause;
        return NULL;
    }
    text[used] = 0;
    *size = used;
    return text;
}

char *text_file_need(const char *path, size_t *size)
{
    char *text = text_file_read(path, size);
    if (!text)
        report_error(path, 0, "cannot read: %s; check the name", strerror(errno));
    return text;
}

char *text_file_read_regular(const char *path, size_t *size)
{
    struct stat status;
    if (stat(path, &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode)) {
        errno = ENOTSUP;
        return NULL;
    }
    return text_file_read(path, size);
}
