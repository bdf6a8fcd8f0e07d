/* name_slots.c - see name_slots.h.
 * SPDX-License-Identifier: MIT */
#include "scene/name_slots.h"

#include <stdlib.h>
#include <string.h>

#include "kernel/hash.h"

/* The slot of that name, or the free one where it belongs; there are slots. */
static uint32_t *slot_of(const struct name_slots *s, char *const *names, const char *name)
{
    uint64_t h = 0;
    for (const char *c = name; *c; c++)
        h = hash64(h + (unsigned char)*c + HASH_STEP);
    uint32_t i = (uint32_t)h & (s->count - 1);
    while (s->slot[i] != NO_NAME && strcmp(names[s->slot[i]], name) != 0)
        i = (i + 1) & (s->count - 1);
    return &s->slot[i];
}

/* Half of the slots stay free. Returns 0, or -1 when out of memory. */
static int grow(struct name_slots *s, char *const *names)
{
    if (s->names < s->count / 2)
        return 0;
    const struct name_slots old = *s;
    const uint32_t count = old.count ? 2 * old.count : 64;
    uint32_t *slot = count ? malloc(count * sizeof *slot) : NULL;
    if (!slot)
        return -1;
    memset(slot, 0xff, count * sizeof *slot); /* NO_NAME */
    s->slot = slot;
    s->count = count;
    for (uint32_t i = 0; i < old.count; i++)
        if (old.slot[i] != NO_NAME)
            *slot_of(s, names, names[old.slot[i]]) = old.slot[i];
    free(old.slot);
    return 0;
}

uint32_t name_slots_find(const struct name_slots *s, char *const *names, const char *name)
{
    return s->count ? *slot_of(s, names, name) : NO_NAME;
}

int name_slots_put(struct name_slots *s, char *const *names, uint32_t i)
{
    const int is_new = name_slots_find(s, names, names[i]) == NO_NAME;
    if (is_new && grow(s, names) < 0)
        return -1;
    *slot_of(s, names, names[i]) = i;
    s->names += (uint32_t)is_new;
    return 0;
}

void name_slots_free(struct name_slots *s)
{
    free(s->slot);
    *s = (struct name_slots){0};
}
