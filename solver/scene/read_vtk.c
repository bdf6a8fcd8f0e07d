/* read_vtk.c - see read_meshes.h: legacy VTK files as text or binary, POLYDATA and
 * UNSTRUCTURED_GRID.
 *
 * Numbers of a text flow over lines; binary ones stand behind the line that says what they are,
 * high bytes first, and of lines only that one is counted. Cells are, up to version 4, a count and
 * as many points each, from version 5 on offsets and points of all. What POINT_DATA and CELL_DATA
 * begin is data on points and cells up to the file's end. [VTK file formats, Simple Legacy Formats]
 * SPDX-License-Identifier: MIT */
#include <string.h>

#include "scene/read_meshes.h"
#include "scene/read_numbers.h"
#include "scene/text_lines.h"
#include "scene/vtk_cells.h"
#include "util/array.h"
#include "util/report.h"

struct cell {
    size_t first, size; /* of `numbers` */
    uint32_t line;
};

struct vtk {
    struct mesh mesh;
    struct text_lines lines;
    double version;
    int grid, has_points; /* 1: UNSTRUCTURED_GRID */
    int binary;
    const struct number_type *type; /* of the bytes that come now; NULL: words */
    double *numbers;                /* points of the cells */
    size_t number_count, number_capacity;
    struct cell *cell; /* of CELLS, which wait for their types */
    size_t cell_count, cell_capacity;
};

/* Numbers of a binary file. vtkIdType is written as int, though it takes 8 bytes in memory. */
static const struct number_type {
    const char *name;
    char kind; /* as of typed_number; 0: no numbers */
    unsigned size;
} number_types[] = {
    {"char", 'I', 1},          {"signed_char", 'I', 1},    {"unsigned_char", 'U', 1},
    {"short", 'I', 2},         {"unsigned_short", 'U', 2}, {"int", 'I', 4},
    {"unsigned_int", 'U', 4},  {"vtkIdType", 'I', 4},      {"long", 'I', 8},
    {"unsigned_long", 'U', 8}, {"vtktypeint64", 'I', 8},   {"vtktypeuint64", 'U', 8},
    {"float", 'F', 4},         {"double", 'F', 8},         {"bit", 0, 0},
    {"string", 0, 0}};
enum { OF_INT = 5 };

/* The next word, which may be on another line. Returns 0, or -1 at the end, after a message when
 * something is wanted. */
static int next_value(struct vtk *v, const char *wanted)
{
    while (!(v->lines.line && next_word(&v->lines)))
        if (!next_line(&v->lines))
            return wanted ? report_error(v->mesh.path, v->lines.number,
                                         "ends before %s; the file is cut, export it again", wanted)
                          : -1;
    return 0;
}

/* So many bytes of a binary file; NULL after a message. */
static const char *take_bytes(struct vtk *v, const char *what, size_t size)
{
    struct text_lines *t = &v->lines;
    const char *at = t->next;
    if (size <= (size_t)(t->end - t->next)) {
        t->next += size;
        return at;
    }
    report_error(v->mesh.path, t->number, "ends before %s; the file is cut, export it again", what);
    return NULL;
}

/* Numbers of the type at hand come behind this line, if the file is binary. */
static int begin_numbers(struct vtk *v)
{
    struct text_lines *t = &v->lines;
    for (size_t i = 0; i < sizeof number_types / sizeof *number_types && v->binary; i++)
        if (word_is_any_case(t, number_types[i].name)) {
            v->type = &number_types[i];
            t->word_end = t->line_end;
            return 0;
        }
    return v->binary ? report_error(v->mesh.path, t->number,
                                    "numbers of type '%.*s', which is not known; write int, float "
                                    "or double",
                                    quoted_length(t->word, t->word_end), t->word)
                     : 0;
}

static void begin_ints(struct vtk *v)
{
    if (!v->binary)
        return;
    v->lines.word_end = v->lines.line_end;
    v->type = &number_types[OF_INT];
}

static int take_number(struct vtk *v, const char *what, double *x)
{
    if (!v->type)
        return next_value(v, what) ? -1 : mesh_number(&v->mesh, &v->lines, what, x);
    const char *at = take_bytes(v, what, v->type->size);
    if (!at)
        return -1;
    *x = typed_number(at, v->type->kind, v->type->size, 1);
    return is_finite_float(*x) ? 0
                               : report_error(v->mesh.path, v->lines.number,
                                              "%s is not finite; write finite numbers", what);
}

static int take_count(struct vtk *v, const char *what, size_t *count)
{
    double x;
    if (take_number(v, what, &x))
        return -1;
    if (!is_whole(x, 0x1p53))
        return report_error(v->mesh.path, v->lines.number,
                            "%g where %s belongs; the file is damaged, export it again", x, what);
    *count = (size_t)x;
    return 0;
}

static int take_word(struct vtk *v, const char *wanted)
{
    if (next_value(v, wanted))
        return -1;
    return word_is_any_case(&v->lines, wanted) ? 0 : mesh_unexpected(&v->mesh, &v->lines, wanted);
}

/* "# vtk DataFile Version 3.0", a title, ASCII. */
static int read_head(struct vtk *v)
{
    struct text_lines *t = &v->lines;
    static const char mark[] = "# vtk DataFile Version ";
    if (!next_line(t) || strncasecmp(t->line, mark, sizeof mark - 1) != 0)
        return report_error(v->mesh.path, 1,
                            "no legacy VTK file: it does not begin with '%s'; "
                            "check the format (XML files are named .vtu or .vtp)",
                            mark);
    v->version = strtod(t->line + sizeof mark - 1, NULL);
    next_line(t);
    t->word_end = t->line_end; /* a title may have words */
    if (next_value(v, "ASCII"))
        return -1;
    v->binary = word_is_any_case(t, "BINARY");
    return v->binary || word_is_any_case(t, "ASCII")
               ? 0
               : report_error(v->mesh.path, t->number,
                              "neither ASCII nor BINARY; the file is damaged, export it again");
}

static int read_points(struct vtk *v)
{
    size_t count;
    double p[3];
    if (v->has_points++)
        return report_error(v->mesh.path, v->lines.number,
                            "POINTS a second time; the file is "
                            "damaged, export it again");
    if (take_count(v, "the number of points", &count) || next_value(v, "float or double"))
        return -1;
    v->mesh.file->single_precision = word_is_any_case(&v->lines, "float");
    if (begin_numbers(v))
        return -1;
    for (size_t i = 0; i < count; i++) {
        for (int k = 0; k < 3; k++)
            if (take_number(v, "a coordinate", &p[k]))
                return -1;
        if (scene_file_add_position(v->mesh.file, p))
            return scene_file_no_memory(v->mesh.path);
    }
    v->type = NULL;
    return 0;
}

static int add_number(struct vtk *v, const char *what)
{
    if (array_reserve(&v->numbers, v->number_count + 1, &v->number_capacity, sizeof *v->numbers))
        return scene_file_no_memory(v->mesh.path);
    return take_number(v, what, &v->numbers[v->number_count++]);
}

static int add_cell(struct vtk *v, size_t first, size_t size, uint32_t line)
{
    if (array_reserve(&v->cell, v->cell_count + 1, &v->cell_capacity, sizeof *v->cell))
        return scene_file_no_memory(v->mesh.path);
    v->cell[v->cell_count++] = (struct cell){first, size, line};
    return 0;
}

/* Offsets of the cells and the end, then all points. */
static int read_offsets(struct vtk *v, size_t offsets, size_t size)
{
    const size_t start = v->number_count;
    if (!offsets && !size)
        return 0;
    if (take_word(v, "OFFSETS") || next_value(v, "a type") || begin_numbers(v))
        return -1;
    for (size_t i = 0; i < offsets; i++) {
        if (add_number(v, "an offset"))
            return -1;
        const double *at = &v->numbers[v->number_count - 1];
        if (!is_whole(*at, (double)size + 1) || (i ? *at < at[-1] : *at > 0))
            return vtk_wrong_offset(&v->mesh, *at, size, v->lines.number);
        if (i
            && add_cell(v, start + offsets + (size_t)at[-1], (size_t)(*at - at[-1]),
                        v->lines.number))
            return -1;
    }
    v->type = NULL;
    if (take_word(v, "CONNECTIVITY") || next_value(v, "a type") || begin_numbers(v))
        return -1;
    for (size_t i = 0; i < size; i++)
        if (add_number(v, "a cell's point"))
            return -1;
    v->type = NULL;
    return 0;
}

static int read_lists(struct vtk *v, size_t count, size_t size)
{
    const uint32_t line = v->lines.number;
    size_t corners, left = size;
    begin_ints(v);
    for (size_t i = 0; i < count; i++) {
        if (take_count(v, "a cell's number of points", &corners))
            return -1;
        if (left < 1 || corners > left - 1)
            return report_error(v->mesh.path, v->lines.number,
                                "cell %zu goes beyond the %zu numbers of all cells; the file is "
                                "damaged, export it again",
                                i, size);
        left -= 1 + corners;
        if (add_cell(v, v->number_count, corners, v->lines.number))
            return -1;
        for (size_t j = 0; j < corners; j++)
            if (add_number(v, "a cell's point"))
                return -1;
    }
    v->type = NULL;
    return left ? report_error(v->mesh.path, line,
                               "%zu cells take %zu numbers less than are counted; the file is "
                               "damaged, export it again",
                               count, left)
                : 0;
}

static int end_cell(struct vtk *v, const struct cell *c, double type)
{
    const struct vtk_points points = {0, v->mesh.file->position_count};
    return vtk_cell(&v->mesh, points, type, c->size ? &v->numbers[c->first] : NULL, c->size,
                    c->line);
}

/* The cells that wait become faces; those of POLYDATA are of one type. */
static int read_cells(struct vtk *v, double type)
{
    size_t count, size;
    if (take_count(v, "the number of cells", &count)
        || take_count(v, "the numbers of all cells", &size)
        || (v->version >= 5 ? read_offsets(v, count, size) : read_lists(v, count, size)))
        return -1;
    for (size_t i = 0; i < v->cell_count && type > 0; i++)
        if (end_cell(v, &v->cell[i], type))
            return -1;
    if (type > 0)
        v->cell_count = v->number_count = 0;
    return 0;
}

static int read_types(struct vtk *v)
{
    size_t count;
    double type;
    if (take_count(v, "the number of types", &count))
        return -1;
    if (count != v->cell_count)
        return vtk_wrong_types(&v->mesh, count, v->cell_count, v->lines.number);
    begin_ints(v);
    for (size_t i = 0; i < count; i++)
        if (take_number(v, "a cell's type", &type) || end_cell(v, &v->cell[i], type))
            return -1;
    v->type = NULL;
    v->cell_count = v->number_count = 0;
    return 0;
}

/* Strings of a binary file: the first two bits say of how many bytes the length is. */
static int pass_strings(struct vtk *v, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const struct text_lines *t = &v->lines;
        const unsigned first = t->next < t->end ? (unsigned char)*t->next : 0,
                       size = 8 >> (first >> 6);
        const char *at = take_bytes(v, "a string", size);
        const uint64_t bits = (uint64_t)1 << (8 * size - 2);
        if (!at || !take_bytes(v, "a string", (size_t)(bytes_number(at, size, 1) & (bits - 1))))
            return -1;
    }
    return 0;
}

static int pass_values(struct vtk *v, size_t count)
{
    if (!v->binary) {
        for (size_t i = 0; i < count; i++)
            if (next_value(v, "a value"))
                return -1;
        return 0;
    }
    if (begin_numbers(v))
        return -1;
    const struct number_type *type = v->type;
    v->type = NULL;
    if (strcmp(type->name, "string") == 0)
        return pass_strings(v, count);
    return take_bytes(v, "a value", type->kind ? count * type->size : count / 8 + (count % 8 > 0))
               ? 0
               : -1;
}

/* FIELD name n, then n times: name, components, tuples, type, values. */
static int pass_field(struct vtk *v)
{
    size_t arrays, components, tuples;
    if (next_value(v, "a field's name") || take_count(v, "a number of arrays", &arrays))
        return -1;
    for (size_t i = 0; i < arrays; i++) {
        if (next_value(v, "an array's name") || take_count(v, "components", &components)
            || take_count(v, "tuples", &tuples) || next_value(v, "a type"))
            return -1;
        /* where a product is too large, more than any file has */
        const size_t most = v->binary ? 8 * (size_t)(v->lines.end - v->lines.next) + 8 : SIZE_MAX;
        if (pass_values(v, components && tuples > most / components ? most : components * tuples))
            return -1;
    }
    return 0;
}

/* Up to an empty line. */
static void pass_metadata(struct vtk *v)
{
    do
        v->lines.word_end = v->lines.line_end;
    while (next_line(&v->lines) && next_word(&v->lines));
}

/* Returns 1 where the mesh ends. */
static int read_section(struct vtk *v)
{
    const struct text_lines *t = &v->lines;
    if (word_is_any_case(t, "POINT_DATA") || word_is_any_case(t, "CELL_DATA"))
        return 1;
    if (word_is_any_case(t, "DATASET")) {
        if (next_value(v, "a kind of dataset"))
            return -1;
        v->grid = word_is_any_case(t, "UNSTRUCTURED_GRID");
        return v->grid || word_is_any_case(t, "POLYDATA")
                   ? 0
                   : report_error(v->mesh.path, t->number,
                                  "dataset %.*s has no faces; write POLYDATA or UNSTRUCTURED_GRID "
                                  "(ParaView: Extract Surface)",
                                  quoted_length(t->word, t->word_end), t->word);
    }
    if (word_is_any_case(t, "FIELD"))
        return pass_field(v);
    if (word_is_any_case(t, "METADATA")) {
        pass_metadata(v);
        return 0;
    }
    if (word_is_any_case(t, "POINTS"))
        return read_points(v);
    if (v->grid ? word_is_any_case(t, "CELL_TYPES") : 0)
        return read_types(v);
    const double type = v->grid ? (word_is_any_case(t, "CELLS") ? 0 : -1)
                        : word_is_any_case(t, "VERTICES") || word_is_any_case(t, "LINES") ? 1
                        : word_is_any_case(t, "POLYGONS")        ? VTK_POLYGON
                        : word_is_any_case(t, "TRIANGLE_STRIPS") ? VTK_STRIP
                                                                 : -1;
    return type >= 0 ? read_cells(v, type)
                     : report_error(v->mesh.path, t->number,
                                    "'%.*s' is no part of such a file; it is damaged, export it "
                                    "again",
                                    quoted_length(t->word, t->word_end), t->word);
}

int read_vtk(struct scene_file *f, const char *path, char *text, size_t size, int quiet)
{
    struct vtk v = {.mesh = {.file = f, .path = path}, .lines = text_lines(text, size)};
    int result = read_head(&v);
    while (!result && next_value(&v, NULL) == 0)
        result = read_section(&v);
    if (result >= 0)
        result = v.cell_count ? report_error(path, v.lines.number,
                                             "ends before CELL_TYPES; the file is cut, export it "
                                             "again")
                              : mesh_finish(&v.mesh, quiet);
    mesh_free(&v.mesh);
    free(v.numbers);
    free(v.cell);
    return result;
}
