/* part_names.h - parts of a scene by the names that its file gives them: groups, objects, solids.
 *
 * A name that comes again means the same part. Nothing is kept for a file that names none: `of` is
 * NULL until the first name comes; polygons before it are the part "default".
 * SPDX-License-Identifier: MIT */
#ifndef PART_NAMES_H
#define PART_NAMES_H

#include <stddef.h>
#include <stdint.h>
#include "scene/name_slots.h"

struct part_names {
    char **names; /* [count] */
    uint32_t count;
    size_t name_capacity;
    uint32_t *of; /* [polygon]: its part; NULL when count is 0 */
    size_t of_capacity;
    uint32_t current; /* part of the polygons to come */
    struct name_slots slots;
};

/* Polygons from `polygons` on, which is how many there are by now, belong to the part of that name,
 * of so many bytes; no bytes: "default". Returns 0, or -1 when out of memory. */
int part_names_use(struct part_names *p, const char *name, size_t length, uint32_t polygons);

/* Polygon number `polygon` comes. Returns 0, or -1 when out of memory. */
int part_names_add(struct part_names *p, uint32_t polygon);

void part_names_free(struct part_names *p);

#endif
