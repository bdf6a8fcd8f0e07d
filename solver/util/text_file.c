/* text_file.c - see text_file.h.
 * SPDX-License-Identifier: MIT */
#include "util/text_file.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

#include "util/array.h"

char *text_file_read(const char *path, size_t *size)
{
    FILE *stream = fopen(path, "rb");
    if (!stream)
        return NULL;
    struct stat status;
    if (fstat(fileno(stream), &status) == 0 && S_ISDIR(status.st_mode)) {
        fclose(stream);
        errno = EISDIR;
        return NULL;
    }
    /* Grown while reading: a pipe has no size to ask for. */
    size_t capacity = 0, used = 0, need = (size_t)(status.st_size > 0 ? status.st_size : 0) + 2;
    char *text = NULL;
    int failed;
    do {
        failed = array_reserve(&text, need, &capacity, 1) < 0 ? ENOMEM : 0;
        if (failed)
            break;
        used += fread(text + used, 1, capacity - used - 1, stream);
        need = capacity + 1;
    } while (used == capacity - 1);
    if (!failed && ferror(stream))
        failed = EIO;
    fclose(stream);
    if (failed) {
        free(text);
        errno = failed;
        return NULL;
    }
    text[used] = 0;
    *size = used;
    return text;
}
