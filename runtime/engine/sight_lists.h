/* sight_lists.h - what may stand between two elements, handed down to what they hold.
 * SPDX-License-Identifier: MIT */
#ifndef SIGHT_LISTS_H
#define SIGHT_LISTS_H

#include "engine/exchange_tree.h"
#include "engine/sight_pieces.h"

/* Ascending; a count of more than SIGHT_LIST: more than that. */
struct sight_list {
    int count;
    uint32_t face[SIGHT_LIST];
};

/* Those of a list that the shaft does not lie aside of. Returns how many. */
int sight_list_near(const struct sight_list *list, const struct exchange_tree *tree,
                    const struct shaft *shaft, uint32_t *faces);
void sight_list_sort(uint32_t *faces, int count);

/* All that may stand in a shaft. */
void sight_list_find(struct sight_list *list, const struct exchange_tree *tree,
                     const struct shaft *shaft);

#endif
