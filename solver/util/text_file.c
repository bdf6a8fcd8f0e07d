/* text_file.c - see text_file.h.
 * SPDX-License-Identifier: MIT */
#include "util/text_file.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

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
    size_t capacity = (size_t)(status.st_size > 0 ? status.st_size : 0) + 4096, used = 0;
    char *text = malloc(capacity);
    while (text) {
        used += fread(text + used, 1, capacity - used - 1, stream);
        if (used < capacity - 1)
            break;
        char *larger = realloc(text, capacity *= 2);
        if (!larger)
            free(text);
        text = larger;
    }
    if (text && ferror(stream)) {
        free(text);
        text = NULL;
        errno = EIO;
    }
    fclose(stream);
    if (text)
        text[used] = 0;
    *size = used;
    return text;
}
