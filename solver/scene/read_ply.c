/* read_ply.c - see read_shapes.h: PLY, a header that lists elements and their properties, then
 * their values as text or as bytes.
 *
 * Of vertices x, y and z are read, of faces and of triangle strips (element tristrips, as scanners
 * write them) vertex_indices; all else is stepped over. Each corner of a strip makes a triangle
 * with the two before it, every second one turned over; -1 begins a new strip.
 * SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <string.h>

#include "scene/read_numbers.h"
#include "scene/read_shapes.h"
#include "scene/text_lines.h"
#include "util/report.h"

enum { ELEMENTS_MOST = 32, PROPERTIES_MOST = 256 };

enum type { I8, U8, I16, U16, I32, U32, F32, F64, TYPES };

static const struct {
    const char *name, *other;
    char kind; /* as of typed_number */
    unsigned size;
} types[TYPES] = {
    [I8] = {"char", "int8", 'I', 1},      [U8] = {"uchar", "uint8", 'U', 1},
    [I16] = {"short", "int16", 'I', 2},   [U16] = {"ushort", "uint16", 'U', 2},
    [I32] = {"int", "int32", 'I', 4},     [U32] = {"uint", "uint32", 'U', 4},
    [F32] = {"float", "float32", 'F', 4}, [F64] = {"double", "float64", 'F', 8},
};

enum role { PASSED_OVER, X, Y, Z, CORNERS, STRIPS };

struct property {
    enum type type, count_type;
    enum role role;
    int list;
};

struct ply_element {
    char name[QUOTED];
    uint64_t count;
    uint32_t first, properties; /* of ply.property */
};

struct ply {
    struct scene_file *file;
    const char *path;
    struct text_lines lines;
    int bytes, big_endian;           /* 0 and 0: text */
    const unsigned char *next, *end; /* of bytes */
    struct ply_element element[ELEMENTS_MOST];
    struct property property[PROPERTIES_MOST];
    uint32_t elements, properties;
};

/* ---- the header */

static int damaged_header(const struct ply *p, const char *why)
{
    return report_error(p->path, p->lines.number,
                        "%s in the PLY header; the file is damaged, export it again", why);
}

static int read_type(struct ply *p, enum type *type)
{
    if (next_word(&p->lines))
        for (int i = 0; i < TYPES; i++)
            if (word_is(&p->lines, types[i].name) || word_is(&p->lines, types[i].other)) {
                *type = (enum type)i;
                return 0;
            }
    return damaged_header(p, "a property of no known type");
}

static int read_format(struct ply *p)
{
    int known = next_word(&p->lines);
    p->big_endian = known && word_is(&p->lines, "binary_big_endian");
    p->bytes = p->big_endian || (known && word_is(&p->lines, "binary_little_endian"));
    return p->bytes || (known && word_is(&p->lines, "ascii"))
               ? 0
               : damaged_header(p, "no known format");
}

static int read_element(struct ply *p)
{
    struct ply_element *e = &p->element[p->elements];
    double count;
    if (p->elements == ELEMENTS_MOST)
        return damaged_header(p, "more than 32 elements");
    if (!next_word(&p->lines))
        return damaged_header(p, "an element without a name");
    snprintf(e->name, sizeof e->name, "%.*s", quoted_length(p->lines.word, p->lines.word_end),
             p->lines.word);
    if (!next_word(&p->lines) || !word_number(&p->lines, &count) || !is_whole(count, 0x1p53))
        return damaged_header(p, "an element without a count");
    e->count = (uint64_t)count;
    e->first = p->properties;
    p->elements++;
    return 0;
}

static int read_property(struct ply *p)
{
    struct property *to = &p->property[p->properties];
    if (!p->elements)
        return damaged_header(p, "a property before any element");
    if (p->properties == PROPERTIES_MOST)
        return damaged_header(p, "more than 256 properties");
    *to = (struct property){.type = F32};
    struct text_lines before = p->lines;
    to->list = next_word(&p->lines) && word_is(&p->lines, "list");
    if (!to->list)
        p->lines = before;
    else if (read_type(p, &to->count_type))
        return -1;
    if (read_type(p, &to->type))
        return -1;
    if (!next_word(&p->lines))
        return damaged_header(p, "a property without a name");
    const char *of = p->element[p->elements - 1].name;
    if (strcmp(of, "vertex") == 0 && !to->list)
        to->role = word_is(&p->lines, "x")   ? X
                   : word_is(&p->lines, "y") ? Y
                   : word_is(&p->lines, "z") ? Z
                                             : PASSED_OVER;
    if (to->list && (word_is(&p->lines, "vertex_indices") || word_is(&p->lines, "vertex_index")))
        to->role = strcmp(of, "face") == 0        ? CORNERS
                   : strcmp(of, "tristrips") == 0 ? STRIPS
                                                  : PASSED_OVER;
    p->element[p->elements - 1].properties++;
    p->properties++;
    return 0;
}

static int read_header(struct ply *p)
{
    int has_format = 0;
    if (!next_line(&p->lines) || !next_word(&p->lines) || !word_is(&p->lines, "ply"))
        return report_error(p->path, 1,
                            "no PLY file: its first line is not 'ply'; check the "
                            "format");
    while (next_line(&p->lines)) {
        int failed = 0;
        if (!next_word(&p->lines))
            continue;
        if (word_is(&p->lines, "end_header")) {
            if (!has_format)
                return damaged_header(p, "no format");
            p->next = (const unsigned char *)p->lines.next;
            p->end = (const unsigned char *)p->lines.end;
            return 0;
        }
        if (word_is(&p->lines, "format")) {
            failed = read_format(p);
            has_format = 1;
        } else if (word_is(&p->lines, "element")) {
            failed = read_element(p);
        } else if (word_is(&p->lines, "property")) {
            failed = read_property(p);
        }
        if (failed)
            return -1;
    }
    return report_error(p->path, 0, "the PLY header has no end; the file is cut, export it again");
}

/* ---- values */

static int cut(const struct ply *p, const struct ply_element *e, uint64_t i)
{
    return report_error(p->path, p->bytes ? 0 : p->lines.number,
                        "ends in %s %llu of the %llu that its header counts; the file is cut or "
                        "damaged, export it again",
                        e->name, (unsigned long long)i, (unsigned long long)e->count);
}

/* Returns 0, or -1 when there is none. */
static int next_value(struct ply *p, enum type type, double *value)
{
    if (!p->bytes)
        return next_word(&p->lines) && word_number(&p->lines, value) ? 0 : -1;
    unsigned size = types[type].size;
    if ((size_t)(p->end - p->next) < size)
        return -1;
    *value = typed_number(p->next, types[type].kind, size, p->big_endian);
    p->next += size;
    return 0;
}

struct strip {
    uint32_t last[2]; /* corners, in the order that the next triangle has them */
    uint32_t length;
};

/* Of corners that are there twice, to turn the strip, comes no triangle. Returns 0, or -1 when out
 * of memory. */
static int add_to_strip(struct scene_file *f, struct strip *s, uint32_t corner, uint32_t line)
{
    uint32_t i = s->length++, *last = s->last;
    if (i >= 2 && last[0] != last[1] && last[0] != corner && last[1] != corner
        && (scene_file_add_corner(f, last[0]) || scene_file_add_corner(f, last[1])
            || scene_file_add_corner(f, corner) || scene_file_add_polygon(f, 3, 0, line)))
        return -1;
    last[i & 1] = corner;
    return 0;
}

static int read_list(struct ply *p, const struct ply_element *e, uint64_t i,
                     const struct property *from, uint64_t vertices)
{
    struct strip strip = {.length = 0};
    double count, value;
    uint32_t line = p->bytes ? 0 : p->lines.number;
    if (next_value(p, from->count_type, &count) || !is_whole(count, 0x1p32))
        return cut(p, e, i);
    for (uint32_t j = 0; j < (uint32_t)count; j++) {
        if (next_value(p, from->type, &value))
            return cut(p, e, i);
        if (from->role == PASSED_OVER)
            continue;
        if (from->role == STRIPS && value >= -1 && value <= -1) {
            strip.length = 0;
            continue;
        }
        if (!is_whole(value, (double)vertices))
            return report_error(p->path, line,
                                "%s %llu names vertex %g, but there are %llu, counted from 0; "
                                "the file is damaged, export it again",
                                e->name, (unsigned long long)i, value,
                                (unsigned long long)vertices);
        if (from->role == STRIPS ? add_to_strip(p->file, &strip, (uint32_t)value, line)
                                 : scene_file_add_corner(p->file, (uint32_t)value))
            return scene_file_no_memory(p->path);
    }
    if (from->role == CORNERS && scene_file_add_polygon(p->file, (uint32_t)count, 0, line))
        return scene_file_no_memory(p->path);
    return 0;
}

static int read_one(struct ply *p, const struct ply_element *e, uint64_t i, uint64_t vertices)
{
    double position[3] = {0, 0, 0}, value;
    if (!p->bytes)
        do
            if (!next_line(&p->lines))
                return cut(p, e, i);
        while (!next_word(&p->lines));
    p->lines.word_end = p->bytes ? p->lines.word_end : p->lines.word; /* taken again */
    for (uint32_t k = 0; k < e->properties; k++) {
        const struct property *from = &p->property[e->first + k];
        if (from->list) {
            if (read_list(p, e, i, from, vertices))
                return -1;
            continue;
        }
        if (next_value(p, from->type, &value))
            return cut(p, e, i);
        if (from->role == PASSED_OVER)
            continue;
        if (!is_finite_float(value))
            return report_error(p->path, p->bytes ? 0 : p->lines.number,
                                "vertex %llu is not finite; correct its coordinates",
                                (unsigned long long)i);
        if (!p->bytes && from->role >= X && from->role <= Z && !p->lines.finer)
            p->lines.finer = is_finer_than_float(p->lines.word, p->lines.word_end, value);
        position[from->role - X] = value;
    }
    if (!p->bytes && next_word(&p->lines))
        return report_error(p->path, p->lines.number,
                            "more numbers for %s %llu than its header says; the file is damaged, "
                            "export it again",
                            e->name, (unsigned long long)i);
    if (strcmp(e->name, "vertex") == 0 && scene_file_add_position(p->file, position))
        return scene_file_no_memory(p->path);
    return 0;
}

static const struct ply_element *find_element(const struct ply *p, const char *name, enum role role)
{
    for (uint32_t i = 0; i < p->elements; i++) {
        const struct ply_element *e = &p->element[i];
        for (uint32_t k = 0; k < e->properties && strcmp(e->name, name) == 0; k++)
            if (p->property[e->first + k].role == role)
                return e;
    }
    return NULL;
}

int read_ply(struct scene_file *file, const char *path, char *text, size_t size, int quiet)
{
    struct ply p = {.file = file, .path = path, .lines = text_lines(text, size)};
    if (read_header(&p))
        return -1;
    const struct ply_element *vertices = find_element(&p, "vertex", X);
    if (!vertices || vertices != find_element(&p, "vertex", Y)
        || vertices != find_element(&p, "vertex", Z)
        || (!find_element(&p, "face", CORNERS) && !find_element(&p, "tristrips", STRIPS)))
        return report_error(path, 0,
                            "no vertices with x, y and z, or neither faces nor triangle strips "
                            "with vertex_indices; export it as polygons");
    for (uint32_t k = 0; k < p.properties; k++)
        file->single_precision |=
            p.property[k].role >= X && p.property[k].role <= Z && p.property[k].type == F32;
    for (uint32_t i = 0; i < p.elements; i++)
        for (uint64_t j = 0; j < p.element[i].count && p.element[i].properties; j++)
            if (read_one(&p, &p.element[i], j, vertices->count))
                return -1;
    file->single_precision &= !p.lines.finer;
    if (p.bytes && p.next < p.end && !quiet)
        report_warning(path, 0, "%zu bytes more than its header counts are passed over",
                       (size_t)(p.end - p.next));
    while (!p.bytes && next_line(&p.lines))
        if (next_word(&p.lines))
            return report_error(path, p.lines.number,
                                "more lines than its header counts; correct the counts");
    if (!p.bytes && !quiet)
        warn_of_cut(path, p.lines.number, text, size);
    return 0;
}
