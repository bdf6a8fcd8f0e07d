/* name_slots.h - which entry of a list of names is called so: by the hash of the name.
 *
 * The list is its owner's, and handed over with each call; of entries of one name the one that was
 * put last is meant.
 * SPDX-License-Identifier: MIT */
#ifndef NAME_SLOTS_H
#define NAME_SLOTS_H

#include <stdint.h>

#define NO_NAME UINT32_MAX /* no entry */

struct name_slots {
    uint32_t *slot; /* [count]: an entry, NO_NAME where there is none; looked at from the hash on */
    uint32_t count, names; /* count: 0 or a power of two; names: slots that are taken */
};

/* The entry of that name, or NO_NAME. */
uint32_t name_slots_find(const struct name_slots *s, char *const *names, const char *name);

/* Entry i is what its name means from now on. Returns 0, or -1 when out of memory, which a name
 * that has an entry never is. */
int name_slots_put(struct name_slots *s, char *const *names, uint32_t i);

void name_slots_free(struct name_slots *s);

#endif
