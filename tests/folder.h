/* folder.h - a folder of a suite's own, for the files that its tests write.
 * SPDX-License-Identifier: MIT */
#ifndef FOLDER_H
#define FOLDER_H

#include <check.h>
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char folder[64];

/* A file's path; good for the next 63 calls, long enough for any one test. */
static inline char *in_folder(const char *name)
{
    static char path[64][512];
    static int turn;
    turn = (turn + 1) % 64;
    snprintf(path[turn], sizeof path[turn], "%.60s/%.200s", folder, name);
    return path[turn];
}

static inline void folder_write(const char *name, const char *text)
{
    FILE *f = fopen(in_folder(name), "w");
    ck_assert_ptr_nonnull(f);
    fputs(text, f);
    ck_assert_int_eq(fclose(f), 0);
}

/* Does a line of the file hold this text? */
static inline int folder_holds(const char *name, const char *text)
{
    char line[1024];
    int found = 0;
    FILE *f = fopen(in_folder(name), "r");
    ck_assert_ptr_nonnull(f);
    while (fgets(line, sizeof line, f))
        found |= strstr(line, text) != NULL;
    (void)fclose(f);
    return found;
}

/* Returns 0, or -1. */
static inline int folder_make(const char *suite)
{
    const char *temporary = getenv("TMPDIR");
    snprintf(folder, sizeof folder, "%.40s/%.15s.XXXXXX", temporary ? temporary : "/tmp", suite);
    return mkdtemp(folder) ? 0 : -1;
}

static inline void folder_remove(void)
{
    DIR *d = opendir(folder);
    for (struct dirent *e; d && (e = readdir(d));)
        if (e->d_name[0] != '.')
            unlink(in_folder(e->d_name));
    if (d)
        closedir(d);
    rmdir(folder);
}

#endif
