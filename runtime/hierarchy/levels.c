/* levels.c - see levels.h.
 * SPDX-License-Identifier: MIT */
#include "hierarchy/levels.h"
#include <stdlib.h>
#include <string.h>

static uint32_t level_of(const struct element *e)
{
    return e->vertices ? 1u + e->depth : 0;
}

int levels_open(struct levels *l, const struct hierarchy *h)
{
    uint32_t *parents = malloc(((size_t)h->count + 1) * sizeof *parents), count = 0,
             to[LEVELS] = {0};
    memset(l, 0, sizeof *l);
    for (uint32_t e = 0; parents && e < h->count; e++)
        if (h->elements[e].children) {
            parents[count++] = e;
            l->from[level_of(&h->elements[e]) + 1]++;
        }
    for (uint32_t i = 0; i < LEVELS; i++) {
        to[i] = l->from[i];
        l->from[i + 1] += l->from[i];
    }
    l->parent = malloc(((size_t)count + 1) * sizeof *l->parent);
    for (uint32_t i = 0; parents && l->parent && i < count; i++)
        l->parent[to[level_of(&h->elements[parents[i]])]++] = parents[i];
    free(parents);
    if (parents && l->parent)
        return 0;
    levels_close(l);
    return -1;
}

void levels_close(struct levels *l)
{
    free(l->parent);
    l->parent = NULL;
}
