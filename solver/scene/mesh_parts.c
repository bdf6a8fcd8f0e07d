/* mesh_parts.c - see mesh_parts.h.
 *
 * The table is never more than half full, and it and the positions grow with what the file names,
 * never with what it counts.
 * SPDX-License-Identifier: MIT */
#include "scene/mesh_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/read_numbers.h"
#include "util/report.h"

/* ---- numbers to indices */

static size_t hash_of(int64_t number)
{
    uint64_t x = (uint64_t)number;
    x = (x ^ (x >> 31)) * 0x7fb5d329728ea185u; /* consecutive numbers come apart */
    x = (x ^ (x >> 27)) * 0x81dadef4bc2dd44du;
    return (size_t)(x ^ (x >> 33));
}

/* Where the number is, or would be. */
static struct numbered_entry *slot_of(const struct numbered *n, int64_t number)
{
    size_t i = hash_of(number) & (n->slots - 1);
    while (n->entry[i].value != UINT32_MAX && n->entry[i].number != number)
        i = (i + 1) & (n->slots - 1);
    return &n->entry[i];
}

uint32_t numbered_find(const struct numbered *n, int64_t number)
{
    return n->slots ? slot_of(n, number)->value : UINT32_MAX;
}

static int enlarge(struct numbered *n)
{
    struct numbered more = {.slots = n->slots ? 2 * n->slots : 64, .count = n->count};
    more.entry = calloc(more.slots, sizeof *more.entry);
    if (!more.entry)
        return -1;
    for (size_t i = 0; i < more.slots; i++)
        more.entry[i].value = UINT32_MAX;
    for (size_t i = 0; i < n->slots; i++)
        if (n->entry[i].value != UINT32_MAX)
            *slot_of(&more, n->entry[i].number) = n->entry[i];
    free(n->entry);
    *n = more;
    return 0;
}

int numbered_add(struct numbered *n, int64_t number, uint32_t value)
{
    if (2 * (n->count + 1) > n->slots && enlarge(n))
        return -1;
    *slot_of(n, number) = (struct numbered_entry){number, value};
    n->count++;
    return 0;
}

/* ---- words */

int mesh_unexpected(const struct mesh *m, const struct text_lines *t, const char *what)
{
    return report_error(m->path, t->number,
                        "'%.*s' where %s belongs; the file is damaged, export it again",
                        quoted_length(t->word, t->word_end), t->word, what);
}

int mesh_number(const struct mesh *m, const struct text_lines *t, const char *what, double *x)
{
    return word_number(t, x) && is_finite_float(*x) ? 0 : mesh_unexpected(m, t, what);
}

/* ---- nodes */

static int node_position(struct mesh *m, int64_t number, uint32_t *position)
{
    const double unknown[3] = {NAN, NAN, NAN};
    *position = numbered_find(&m->nodes, number);
    if (*position != UINT32_MAX)
        return 0;
    *position = (uint32_t)m->file->position_count;
    return scene_file_add_position(m->file, unknown) || numbered_add(&m->nodes, number, *position)
               ? scene_file_no_memory(m->path)
               : 0;
}

int mesh_define_node(struct mesh *m, int64_t number, const double position[3], uint32_t line)
{
    uint32_t index;
    for (int k = 0; k < 3; k++)
        if (!is_finite_float(position[k]))
            return report_error(m->path, line,
                                "node %lld has a coordinate that is not finite; write a finite "
                                "number",
                                (long long)number);
    if (node_position(m, number, &index))
        return -1;
    double *at = &m->file->positions[3 * (size_t)index];
    if (!isnan(*at) && memcmp(at, position, 3 * sizeof *at) != 0)
        return report_error(m->path, line,
                            "node %lld is defined twice, at two places; remove one of them",
                            (long long)number);
    memcpy(at, position, 3 * sizeof *at);
    return 0;
}

int mesh_corner(struct mesh *m, int64_t number)
{
    uint32_t index;
    if (node_position(m, number, &index))
        return -1;
    return scene_file_add_corner(m->file, index) ? scene_file_no_memory(m->path) : 0;
}

int mesh_polygon(struct mesh *m, uint32_t size, uint32_t material, uint32_t line)
{
    return scene_file_add_polygon(m->file, size, material, line) ? scene_file_no_memory(m->path)
                                                                 : 0;
}

/* ---- materials */

int mesh_material(struct mesh *m, const char *name, size_t length, double reflectance,
                  uint32_t *material)
{
    const struct RadMaterial grey = {.reflectance = {reflectance, reflectance, reflectance}};
    uint64_t hash = 0xcbf29ce484222325u;
    for (size_t i = 0; i < length; i++)
        hash = (hash ^ (unsigned char)name[i]) * 0x100000001b3u;
    for (;; hash++) { /* on, past others of the same hash */
        const uint32_t found = *material = numbered_find(&m->materials, (int64_t)hash);
        if (found == UINT32_MAX)
            break;
        if (strlen(m->file->names[found]) == length
            && memcmp(m->file->names[found], name, length) == 0
            && memcmp(&m->file->materials[found], &grey, sizeof grey) == 0)
            return 0;
    }
    char *copy = strndup(name, length);
    *material = m->file->material_count;
    const int failed = !copy || scene_file_add_material(m->file, copy, &grey)
                       || numbered_add(&m->materials, (int64_t)hash, *material);
    free(copy);
    return failed ? scene_file_no_memory(m->path) : 0;
}

/* ---- the end */

void mesh_note(struct mesh_note *n, uint32_t line)
{
    if (!n->count++)
        n->first = line;
}

static int report_missing(const struct mesh *m, uint32_t position, uint32_t line)
{
    for (size_t i = 0; i < m->nodes.slots; i++)
        if (m->nodes.entry[i].value == position)
            return report_error(m->path, line,
                                "this face names node %lld, which is not in the file; the file is "
                                "cut or damaged, export it again",
                                (long long)m->nodes.entry[i].number);
    return report_error(
        m->path, line,
        "this face names a node that is not in the file; it is cut or damaged, export it again");
}

int mesh_finish(struct mesh *m, int quiet)
{
    const struct scene_file *f = m->file;
    size_t at = 0;
    for (uint32_t i = 0; i < f->polygon_count; i++)
        for (uint32_t j = 0; j < f->sizes[i]; j++, at++)
            if (isnan(f->positions[3 * (size_t)f->indices[at]]))
                return report_missing(m, f->indices[at], f->lines[i]);
    if (!f->polygon_count)
        return report_error(m->path, m->volumes.first,
                            m->volumes.count
                                ? "there are volumes in it and no face; export its surface, as "
                                  "triangles or quads"
                                : "there is no face in it; a scene needs one triangle or quad at "
                                  "least");
    if (m->volumes.count && !quiet)
        report_warning(m->path, m->volumes.first,
                       "%lu elements that fill space are passed over; faces alone are read",
                       (unsigned long)m->volumes.count);
    if (m->curved.count && !quiet)
        report_warning(m->path, m->curved.first,
                       "nodes beside the corners of faces are not read (%lu such faces): faces "
                       "are flat between corners; where they should bend, export smaller ones",
                       (unsigned long)m->curved.count);
    return 0;
}

void mesh_free(struct mesh *m)
{
    free(m->nodes.entry);
    free(m->materials.entry);
}
