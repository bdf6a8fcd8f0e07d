/* sight_lists.c - what may stand between two elements, handed down to what they hold.
 *
 * Shafts nest, so what stands between two faces of two groups is of the groups' list: the tree is
 * asked once for all pairs, and lists get shorter with what they are for.
 * Invariant: every face that meets the shaft is in the list.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include "engine/sight_lists.h"
#include "kernel/shaft.h"
#include "util/array.h"
#include "visibility/candidates.h"

void sight_list_sort(uint32_t *faces, int count)
{
    qsort(faces, (size_t)count, sizeof *faces, compare_words);
}

int sight_list_near(const struct sight_list *list, const struct exchange_tree *t,
                    const struct shaft *shaft, uint32_t *faces)
{
    int count = 0;
    for (int i = 0; i < list->count; i++) {
        const struct element *e = &t->h.elements[list->face[i]];
        if (!shaft_far(shaft, (const double(*)[3])e->vertex, e->vertices))
            faces[count++] = list->face[i];
    }
    return count;
}

void sight_list_find(struct sight_list *list, const struct exchange_tree *t,
                     const struct shaft *shaft)
{
    list->count = candidates_find(&t->h, shaft, t->host.ray_offset, SIGHT_LIST, list->face);
    if (list->count <= SIGHT_LIST)
        sight_list_sort(list->face, list->count);
}
