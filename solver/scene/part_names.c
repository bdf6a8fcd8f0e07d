/* part_names.c - see part_names.h.
 * SPDX-License-Identifier: MIT */
#include "scene/part_names.h"

#include <stdlib.h>
#include <string.h>

#include "kernel/hash.h"
#include "util/array.h"

#define NONE UINT32_MAX /* no part */

/* The slot of that name, or the free one where it belongs. */
static uint32_t *find_slot(const struct part_names *p, const char *name)
{
    uint64_t h = 0;
    for (const char *c = name; *c; c++)
        h = hash64(h + (unsigned char)*c + HASH_STEP);
    uint32_t i = (uint32_t)h & (p->slot_count - 1);
    while (p->slots[i] != NONE && strcmp(p->names[p->slots[i]], name) != 0)
        i = (i + 1) & (p->slot_count - 1);
    return &p->slots[i];
}

/* Half of the slots stay free. Returns 0, or -1 when out of memory. */
static int grow_slots(struct part_names *p)
{
    if (p->count < p->slot_count / 2)
        return 0;
    uint32_t count = p->slot_count ? 2 * p->slot_count : 64;
    uint32_t *slots = count ? malloc(count * sizeof *slots) : NULL;
    if (!slots)
        return -1;
    free(p->slots);
    p->slots = slots;
    p->slot_count = count;
    memset(slots, 0xff, count * sizeof *slots); /* NONE */
    for (uint32_t i = 0; i < p->count; i++)
        *find_slot(p, p->names[i]) = i;
    return 0;
}

/* Makes that name's part the current one. Takes over `name`. Returns 0, or -1. */
static int use(struct part_names *p, char *name)
{
    if (!name || grow_slots(p))
        return free(name), -1;
    uint32_t *slot = find_slot(p, name);
    if (*slot == NONE) {
        if (array_reserve(&p->names, (size_t)p->count + 1, &p->name_capacity, sizeof *p->names))
            return free(name), -1;
        p->names[p->count] = name;
        *slot = p->count++;
    } else {
        free(name);
    }
    p->current = *slot;
    return 0;
}

int part_names_use(struct part_names *p, const char *name, size_t length, uint32_t polygons)
{
    if (!p->of) {
        if (array_reserve(&p->of, (size_t)polygons + 1, &p->of_capacity, sizeof *p->of)
            || (polygons && use(p, strdup("default"))))
            return -1;
        memset(p->of, 0, polygons * sizeof *p->of);
    }
    return use(p, length ? strndup(name, length) : strdup("default"));
}

int part_names_add(struct part_names *p, uint32_t polygon)
{
    if (!p->of)
        return 0;
    if (array_reserve(&p->of, (size_t)polygon + 1, &p->of_capacity, sizeof *p->of))
        return -1;
    p->of[polygon] = p->current;
    return 0;
}

void part_names_free(struct part_names *p)
{
    for (uint32_t i = 0; i < p->count; i++)
        free(p->names[i]);
    free(p->names);
    free(p->of);
    free(p->slots);
    *p = (struct part_names){0};
}
