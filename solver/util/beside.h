/* beside.h - the paths of files that belong to another one.
 * SPDX-License-Identifier: MIT */
#ifndef BESIDE_H
#define BESIDE_H

#include <stdlib.h>
#include <string.h>

/* `name`, of so many bytes, from the folder of `path` on, unless it starts at the root; for free().
 * NULL when out of memory. */
static inline char *path_beside(const char *path, const char *name, size_t length)
{
    const char *slash = strrchr(path, '/');
    const size_t folder = slash && *name != '/' ? (size_t)(slash - path) + 1 : 0;
    char *joined = malloc(folder + length + 1);
    if (joined) {
        memcpy(joined, path, folder);
        memcpy(joined + folder, name, length);
        joined[folder + length] = 0;
    }
    return joined;
}

/* `path`, which has an ending, with another one; for free(). NULL when out of memory. */
static inline char *path_with_ending(const char *path, const char *end)
{
    const size_t stem = (size_t)(strrchr(path, '.') - path);
    char *text = malloc(stem + strlen(end) + 1);
    if (text) {
        memcpy(text, path, stem);
        strcpy(text + stem, end);
    }
    return text;
}

#endif
