/* element_names.c - see element_names.h.
 * SPDX-License-Identifier: MIT */
#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "engine/element_names.h"

uint32_t *element_names_parts(const struct face *faces, uint32_t count)
{
    uint32_t inputs = 0;
    for (uint32_t i = 0; i < count; i++)
        inputs = faces[i].input >= inputs ? faces[i].input + 1 : inputs;
    uint32_t *parts = malloc(((size_t)count + 1) * sizeof *parts),
             *seen = calloc(2 * (size_t)inputs + 1, sizeof *seen);
    if (!parts || !seen) {
        free(parts);
        free(seen);
        return NULL;
    }
    for (uint32_t i = 0; i < count; i++)
        parts[i] = ++seen[2 * (size_t)faces[i].input + (faces[i].back != 0)];
    for (uint32_t i = 0; i < count; i++)
        if (seen[2 * (size_t)faces[i].input + (faces[i].back != 0)] == 1)
            parts[i] = 0;
    free(seen);
    return parts;
}

static int is_face(const struct hierarchy *h, uint32_t element)
{
    const struct element *e = &h->elements[element];
    return element < h->built && e->vertices && h->face_element[e->face] == element;
}

static int face_name(char *name, size_t size, const struct hierarchy *h, const uint32_t *parts,
                     uint32_t face)
{
    const struct face *f = &h->faces[face];
    char part[16] = "";
    if (parts[face])
        snprintf(part, sizeof part, ".%u", (unsigned)parts[face] - 1);
    return snprintf(name, size, "%u%s%s", (unsigned)f->input, part, f->back ? "b" : "");
}

int element_name(char *name, size_t size, const struct hierarchy *h, const uint32_t *parts,
                 uint32_t element)
{
    unsigned char way[RAD_NAME]; /* from the element up */
    size_t steps = 0;
    uint32_t e = element;
    for (; e != 0 && !is_face(h, e); e = h->elements[e].parent) {
        if (steps == sizeof way)
            return -1;
        way[steps++] = (unsigned char)(e - h->elements[h->elements[e].parent].child);
    }
    size_t used = (size_t)(is_face(h, e) ? face_name(name, size, h, parts, h->elements[e].face)
                                         : snprintf(name, size, "root"));
    while (steps > 0 && used < size)
        used += (size_t)snprintf(name + used, size - used, "/%u", way[--steps]);
    return used < size ? 0 : -1;
}

/* The number at *at, and *at behind it. Returns 0, or -1: there is none. */
static int read_number(const char **at, uint32_t *number)
{
    char *end;
    if (!isdigit((unsigned char)**at))
        return -1;
    errno = 0;
    unsigned long n = strtoul(*at, &end, 10);
    *at = end;
    *number = n >= UINT32_MAX || errno ? UINT32_MAX : (uint32_t)n;
    return 0;
}

/* The face that the name begins with. */
static int find_face(uint32_t *element, const struct hierarchy *h, const uint32_t *parts,
                     const char *name, const char **rest, char *cause, size_t size)
{
    uint32_t input, part = 0, most = 0, of_side = 0, fronts = 0;
    const char *at = name;
    if (read_number(&at, &input) < 0) {
        snprintf(cause, size,
                 "'%s' names no element; 12 is polygon 12, 12/0/3 a part of it, "
                 "root/1 a cluster",
                 name);
        return -1;
    }
    const int has_part = *at == '.';
    if (has_part && (at++, read_number(&at, &part) < 0)) {
        snprintf(cause, size, "'%s': a number comes behind the '.', as in 12.0", name);
        return -1;
    }
    const int back = *at == 'b';
    *rest = at + back;
    for (uint32_t i = 0; i < h->face_count; i++) {
        const struct face *f = &h->faces[i];
        most = f->input > most ? f->input : most;
        if (f->input != input)
            continue;
        fronts += !f->back;
        if ((f->back != 0) != back)
            continue;
        if (has_part ? parts[i] && parts[i] - 1 == part : !parts[i]) {
            *element = h->face_element[i];
            return 0;
        }
        of_side++;
    }
    if (of_side == 1)
        snprintf(cause, size, "polygon %u is one face; write %u%s", (unsigned)input,
                 (unsigned)input, back ? "b" : "");
    else if (of_side)
        snprintf(cause, size, "polygon %u became %u faces; write %u.0%s to %u.%u%s",
                 (unsigned)input, (unsigned)of_side, (unsigned)input, back ? "b" : "",
                 (unsigned)input, (unsigned)of_side - 1, back ? "b" : "");
    else if (fronts)
        snprintf(cause, size, "polygon %u has one side, and so no %s", (unsigned)input, name);
    else if (input > most)
        snprintf(cause, size, "there is no polygon %s; they are numbered from 0 to %u", name,
                 (unsigned)most);
    else
        snprintf(cause, size, "polygon %u has no area, and so no face", (unsigned)input);
    return -1;
}

int element_find(uint32_t *element, const struct hierarchy *h, const uint32_t *parts,
                 const char *name, char *cause, size_t size)
{
    const char *at = name + 4;
    *element = 0;
    if (strncmp(name, "root", 4) != 0 && find_face(element, h, parts, name, &at, cause, size) < 0)
        return -1;
    while (*at == '/') {
        const struct element *e = &h->elements[*element];
        const char *here = at++;
        uint32_t child;
        if (read_number(&at, &child) < 0)
            break;
        if (e->children == 0) {
            snprintf(cause, size, "there is no %s: %.*s has not been split", name,
                     (int)(here - name), name);
            return -1;
        }
        if (child >= e->children) {
            snprintf(cause, size, "there is no %s: the parts of %.*s are numbered from 0 to %u",
                     name, (int)(here - name), name, (unsigned)e->children - 1);
            return -1;
        }
        *element = e->child + child;
    }
    if (!*at)
        return 0;
    snprintf(cause, size, "'%s': what is '%s'? Write 12/0/3 for a part, root/1 for a cluster", name,
             at);
    return -1;
}
