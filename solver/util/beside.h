/* beside.h - the parts of a path, and the paths of files that belong to another one.
 * SPDX-License-Identifier: MIT */
#ifndef BESIDE_H
#define BESIDE_H

#include <stdlib.h>
#include <string.h>

/* Does it stand for standard output? NULL is no path. */
static inline int path_is_stdout(const char *path)
{
    return path && strcmp(path, "-") == 0;
}

/* What is behind the last folder. */
static inline const char *path_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

/* Bytes of such a name without its ending; a dot at its beginning begins none. */
static inline size_t path_stem(const char *name)
{
    const char *dot = strrchr(name, '.');
    return dot && dot > name ? (size_t)(dot - name) : strlen(name);
}

/* `name`, of so many bytes, from the folder of `path` on, unless it starts at the root; for free().
 * NULL when out of memory. */
static inline char *path_beside(const char *path, const char *name, size_t length)
{
    const size_t folder = *name != '/' ? (size_t)(path_name(path) - path) : 0;
    char *joined = malloc(folder + length + 1);
    if (joined) {
        memcpy(joined, path, folder);
        memcpy(joined + folder, name, length);
        joined[folder + length] = 0;
    }
    return joined;
}

/* `path` and more behind it; for free(). NULL when out of memory. */
static inline char *path_and(const char *path, const char *end)
{
    char *text = malloc(strlen(path) + strlen(end) + 1);
    return text ? strcat(strcpy(text, path), end) : NULL;
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
