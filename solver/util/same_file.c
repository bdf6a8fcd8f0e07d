/* same_file.c - see same_file.h.
 * SPDX-License-Identifier: MIT */
#include "util/same_file.h"

#include <libgen.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* The folder that a file is in, and its name there. Returns 0, or -1 when there is no such folder.
 */
static int place_of(const char *path, struct stat *folder, char **name)
{
    char *above = strdup(path), *base = strdup(path);
    const int failed = !above || !base || stat(dirname(above), folder) ? -1 : 0;
    *name = failed ? NULL : strdup(basename(base));
    free(above);
    free(base);
    return *name ? 0 : -1;
}

int same_file(const char *a, const char *b)
{
    struct stat x, y;
    const int here = stat(a, &x) == 0, there = stat(b, &y) == 0;
    if (here && there)
        return x.st_dev == y.st_dev && x.st_ino == y.st_ino;
    if (here != there)
        return 0;
    char *name = NULL, *other = NULL;
    const int same =
        strcmp(a, b) == 0
        || (place_of(a, &x, &name) == 0 && place_of(b, &y, &other) == 0 && x.st_dev == y.st_dev
            && x.st_ino == y.st_ino && strcmp(name, other) == 0);
    free(name);
    free(other);
    return same;
}
