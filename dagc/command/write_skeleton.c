/* write_skeleton.c - a skeleton's files in a folder.
 *
 * A file that is there is its user's and stays: after a tool has been added to the catalog, the
 * same command makes the one file that is missing.
 * SPDX-License-Identifier: MIT */
#define _XOPEN_SOURCE 700

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/write.h"
#include "command/write_skeleton.h"

const char *dag_seen_from(struct dag *dag, const char *folder, const char *path)
{
    const char *up = "";
    int far = folder[0] == '/' || path[0] == '/' || strstr(folder, "..") != NULL;
    if (far) {
        char *real = realpath(path, NULL);
        const char *copy = dag_format(&dag->arena, "%s", real != NULL ? real : path);
        free(real);
        return copy;
    }
    for (const char *at = folder; *at != '\0';) {
        size_t length = strcspn(at, "/");
        if (length > 0 && !(length == 1 && *at == '.'))
            up = dag_format(&dag->arena, "%s../", up);
        at += length + (at[length] == '/');
    }
    return dag_format(&dag->arena, "%s%s", up, path);
}

/* Every folder before a '/' of the path. */
static int make_folders(const char *path)
{
    char *copy = strdup(path);
    int bad = copy == NULL;
    for (char *at = copy; !bad && (at = strchr(at + 1, '/')) != NULL;) {
        *at = '\0';
        bad = mkdir(copy, 0777) != 0 && errno != EEXIST;
        *at = '/';
    }
    if (bad)
        fprintf(stderr, "dagc: error: cannot make the folder of %s: %s\n", path, strerror(errno));
    free(copy);
    return bad ? -1 : 0;
}

int dag_write_skeleton(struct skeleton *skeleton, const char *folder)
{
    struct output *outputs = calloc((size_t)skeleton->file_count, sizeof *outputs);
    struct stat status;
    int result = outputs == NULL ? -1 : 0;
    for (int i = 0; i < skeleton->file_count && result == 0; i++) {
        const char *path =
            dag_format(&skeleton->dag->arena, "%s/%s", folder, skeleton->files[i].name);
        if (stat(path, &status) == 0) {
            printf("there already: %s\n", path);
            continue;
        }
        outputs[i].path = path;
        outputs[i].text = skeleton->files[i].text;
        result = make_folders(path);
    }
    if (result == 0)
        result = dag_write_outputs(outputs, skeleton->file_count);
    for (int i = 0; i < skeleton->file_count && result == 0; i++)
        if (outputs[i].path != NULL)
            printf("made: %s\n", outputs[i].path);
    if (result == 0)
        printf("make -C %s && %s/%s\n", folder, folder, skeleton->name);
    free(outputs);
    return result;
}
