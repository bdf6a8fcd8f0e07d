/* part_names.c - see part_names.h.
 * SPDX-License-Identifier: MIT */
#include "scene/part_names.h"

#include <stdlib.h>
#include <string.h>

#include "util/array.h"

/* Makes that name's part the current one. Takes over `name`. Returns 0, or -1. */
static int use(struct part_names *p, char *name)
{
    if (!name)
        return -1;
    uint32_t part = name_slots_find(&p->slots, p->names, name);
    if (part == NO_NAME) {
        if (array_reserve(&p->names, (size_t)p->count + 1, &p->name_capacity, sizeof *p->names))
            return free(name), -1;
        part = p->count;
        p->names[part] = name;
        if (name_slots_put(&p->slots, p->names, part) < 0)
            return free(name), -1;
        p->count++;
    } else {
        free(name);
    }
    p->current = part;
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
    name_slots_free(&p->slots);
    *p = (struct part_names){0};
}
