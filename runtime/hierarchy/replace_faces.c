/* replace_faces.c - see replace_faces.h.
 * SPDX-License-Identifier: MIT */
#include "hierarchy/replace_faces.h"

#include <stdlib.h>
#include <string.h>

#include "util/array.h"

int replace_faces(struct scene *scene, struct replacement *list, size_t count)
{
    size_t most = scene->face_count, next = 0;
    for (size_t i = 0; i < count; i++)
        most += list[i].count;
    struct face *faces = most <= UINT32_MAX ? malloc((most + 1) * sizeof *faces) : NULL;
    if (!faces)
        return -1;
    qsort(list, count, sizeof *list, compare_words);
    uint32_t n = 0;
    for (uint32_t i = 0; i < scene->face_count; i++) {
        const struct replacement *x = &list[next];
        if (next == count || x->face != i) {
            faces[n++] = scene->faces[i];
            continue;
        }
        if (x->count)
            memcpy(&faces[n], x->by, x->count * sizeof *faces);
        n += (uint32_t)x->count;
        i += (uint32_t)scene_is_pair(scene, i);
        next++;
    }
    free(scene->faces);
    scene->faces = faces;
    scene->face_count = n;
    return 0;
}
