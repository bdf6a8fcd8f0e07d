/* read_vtk_xml.c - see read_meshes.h: VTK's XML files, UnstructuredGrid (.vtu) and PolyData (.vtp),
 * by expat.
 *
 * A piece's arrays are kept until the piece ends, as texts are read; then its cells become faces.
 * Arrays stand inline, as numbers or as base64, which zlib may have compressed in blocks: before
 * them are their number, their size, the last one's (0: as the others) and what each takes.
 * [VTK file formats, XML File Formats]
 * SPDX-License-Identifier: MIT */
#include <expat.h>
#include <stdio.h>
#include <string.h>
#include <zlib.h>

#include "scene/base64.h"
#include "scene/read_meshes.h"
#include "scene/read_numbers.h"
#include "scene/vtk_cells.h"
#include "util/array.h"
#include "util/report.h"

struct values {
    double *at;
    size_t count, capacity;
    uint32_t line; /* where they begin */
};

enum { POINTS, CELLS, VERTS, LINES, STRIPS, POLYS, SECTIONS };
enum { CONNECTIVITY, OFFSETS, TYPES, ARRAYS };

struct xml {
    struct mesh mesh;
    XML_Parser parser;
    int failed, known, big_endian, base64, compressed;
    unsigned header;      /* bytes of the length before base64 data */
    int section;          /* SECTIONS: in none */
    unsigned nested;      /* elements begun in the array, which say more of it */
    struct values *array; /* the one under way, or NULL */
    struct values list[SECTIONS][ARRAYS];
    double points, cells; /* what the piece counts; -1: does not */
    char type[16];        /* of the array under way */
    char *text;
    size_t text_size, text_capacity;
};

static uint32_t line_of(const struct xml *x)
{
    return (uint32_t)XML_GetCurrentLineNumber(x->parser);
}

/* A message has been written: no more of the file. */
static void fail(struct xml *x, int result)
{
    if (result && !x->failed) {
        x->failed = 1;
        XML_StopParser(x->parser, XML_FALSE);
    }
}

static const char *attribute(const char **all, const char *name)
{
    for (; *all; all += 2)
        if (strcmp(*all, name) == 0)
            return all[1];
    return NULL;
}

static int is(const char *text, const char *what)
{
    return text && strcasecmp(text, what) == 0;
}

/* ---- the values of an array */

static int add_value(struct xml *x, double value)
{
    struct values *v = x->array;
    if (!(fabs(value) <= (double)FLT_MAX))
        return report_error(x->mesh.path, v->line,
                            "an array has a number that is not finite; write finite numbers");
    if (array_reserve(&v->at, v->count + 1, &v->capacity, sizeof *v->at))
        return scene_file_no_memory(x->mesh.path);
    v->at[v->count++] = value;
    return 0;
}

static int read_words(struct xml *x)
{
    const char *from = x->text, *const end = x->text + x->text_size;
    for (;;) {
        while (from < end && (is_blank(*from) || *from == '\n'))
            from++;
        if (from == end)
            return 0;
        char *stop;
        const double value = strtod(from, &stop);
        if (stop == from || !(stop == end || is_blank(*stop) || *stop == '\n')) {
            const char *word_end = from;
            while (word_end < end && !is_blank(*word_end) && *word_end != '\n')
                word_end++;
            return report_error(x->mesh.path, x->array->line,
                                "'%.*s' is not a number in this array; the file is damaged, export "
                                "it again",
                                quoted_length(from, word_end), from);
        }
        if (add_value(x, value))
            return -1;
        from = stop;
    }
}

/* The number that these bytes are. */
static double value_of(const struct xml *x, const char *from, unsigned size)
{
    const uint64_t bits = bytes_number(from, size, x->big_endian);
    if (*x->type == 'F') {
        const uint32_t low = (uint32_t)bits;
        float single;
        double value;
        memcpy(&single, &low, sizeof single);
        memcpy(&value, &bits, sizeof value);
        return size == 4 ? (double)single : value;
    }
    const uint64_t sign = (uint64_t)1 << (8 * size - 1);
    return *x->type == 'I' && bits & sign ? -(double)(~bits & (sign - 1)) - 1 : (double)bits;
}

static int damaged_blocks(const struct xml *x)
{
    return report_error(x->mesh.path, x->array->line,
                        "the blocks of a compressed array are not what is counted; the file is cut "
                        "or damaged, export it again");
}

/* What is compressed in x->text becomes plain there, behind its length, as if it had never been.
 * zlib makes at most 1032 bytes of one, so that no count asks for more memory than it may fill. */
static int inflate_blocks(struct xml *x, size_t *bytes)
{
    enum { MOST_OF_ONE = 1032 };
    const size_t word = x->header;
    uint64_t count, size, last, taken;
    if (*bytes < word)
        return damaged_blocks(x);
    count = bytes_number(x->text, x->header, x->big_endian);
    if (count && (*bytes < 3 * word || count > (*bytes - 3 * word) / word))
        return damaged_blocks(x);
    size = count ? bytes_number(x->text + word, x->header, x->big_endian) : 0;
    last = count ? bytes_number(x->text + 2 * word, x->header, x->big_endian) : 0;
    size_t from = count ? (3 + (size_t)count) * word : word, to = word, room = 0;
    char *plain = NULL;
    int result = array_reserve(&plain, word, &room, 1) ? scene_file_no_memory(x->mesh.path) : 0;
    for (uint64_t i = 0; i < count && !result; i++, from += taken) {
        const uint64_t wanted = i + 1 == count && last ? last : size;
        taken = bytes_number(x->text + (3 + i) * word, x->header, x->big_endian);
        uLongf made = (uLongf)wanted;
        if (taken > *bytes - from || wanted / MOST_OF_ONE > taken)
            result = damaged_blocks(x);
        else if (array_reserve(&plain, to + (size_t)wanted, &room, 1))
            result = scene_file_no_memory(x->mesh.path);
        else if (uncompress((Bytef *)plain + to, &made, (const Bytef *)x->text + from, (uLong)taken)
                     != Z_OK
                 || made != wanted)
            result = damaged_blocks(x);
        to += (size_t)wanted;
    }
    if (result || from != *bytes) {
        free(plain);
        return result ? result : damaged_blocks(x);
    }
    for (size_t k = 0; k < word; k++)
        plain[x->big_endian ? word - 1 - k : k] = (char)((uint64_t)(to - word) >> 8 * k & 0xff);
    free(x->text);
    x->text = plain;
    x->text_capacity = room;
    *bytes = to;
    return 0;
}

static int read_bytes(struct xml *x)
{
    const char *number = strpbrk(x->type, "0123456789");
    const unsigned size = number ? (unsigned)strtoul(number, NULL, 10) / 8 : 0;
    const uint32_t line = x->array->line;
    if ((size != 1 && size != 2 && size != 4 && size != 8) || !strchr("FIU", *x->type)
        || (*x->type == 'F' && size < 4))
        return report_error(x->mesh.path, line, "an array of type '%s'; write Float64 and Int64",
                            x->type);
    size_t bytes = from_base64(x->text, x->text_size);
    if (bytes == SIZE_MAX || bytes < x->header)
        return report_error(x->mesh.path, line,
                            "an array is no base64; the file is cut or damaged, export it again");
    if (x->compressed && inflate_blocks(x, &bytes))
        return -1;
    const uint64_t counted = bytes_number(x->text, x->header, x->big_endian);
    if (counted != bytes - x->header || counted % size)
        return report_error(x->mesh.path, line,
                            "an array counts %llu bytes of type %s and has %zu; the file is cut or "
                            "damaged, export it again",
                            (unsigned long long)counted, x->type, bytes - x->header);
    for (size_t at = x->header; at < bytes; at += size)
        if (add_value(x, value_of(x, x->text + at, size)))
            return -1;
    return 0;
}

/* ---- pieces */

static int counts_differ(struct xml *x, const char *what, double counted, size_t has)
{
    return report_error(
        x->mesh.path, line_of(x),
        "a piece counts %.15g %s and has %zu; the file is cut or damaged, export it "
        "again",
        counted, what, has);
}

static int add_points(struct xml *x, struct vtk_points *points)
{
    const struct values *p = &x->list[POINTS][CONNECTIVITY];
    *points = (struct vtk_points){x->mesh.file->position_count, p->count / 3};
    if (p->count % 3)
        return report_error(x->mesh.path, p->line,
                            "points have %zu numbers, not three each; the file is damaged, export "
                            "it again",
                            p->count);
    if (x->points >= 0 && (x->points < (double)points->count || x->points > (double)points->count))
        return counts_differ(x, "points", x->points, points->count);
    for (size_t i = 0; i < points->count; i++)
        if (scene_file_add_position(x->mesh.file, &p->at[3 * i]))
            return scene_file_no_memory(x->mesh.path);
    return 0;
}

/* Cells of a section: offsets are where each ends. */
static int add_cells(struct xml *x, struct vtk_points points, int section)
{
    static const double types[SECTIONS] = {
        [VERTS] = 1, [LINES] = 3, [STRIPS] = VTK_STRIP, [POLYS] = VTK_POLYGON};
    const struct values *list = x->list[section], *offsets = &list[OFFSETS],
                        *corners = &list[CONNECTIVITY];
    double from = 0;
    if (section == CELLS && list[TYPES].count != offsets->count)
        return report_error(x->mesh.path, list[TYPES].line,
                            "%zu types of %zu cells; the file is damaged, export it again",
                            list[TYPES].count, offsets->count);
    for (size_t i = 0; i < offsets->count; i++) {
        const double to = offsets->at[i];
        if (!is_whole(to, (double)corners->count + 1) || to < from)
            return report_error(x->mesh.path, offsets->line,
                                "offset %g is less than the one before it, or more than the %zu "
                                "points of all cells; the file is damaged, export it again",
                                to, corners->count);
        const double *first = corners->at ? corners->at + (size_t)from : NULL;
        if (vtk_cell(&x->mesh, points, section == CELLS ? list[TYPES].at[i] : types[section], first,
                     (size_t)(to - from), corners->line))
            return -1;
        from = to;
    }
    return from < (double)corners->count
               ? report_error(x->mesh.path, corners->line,
                              "cells take %g of %zu points; the file is cut or damaged, export it "
                              "again",
                              from, corners->count)
               : 0;
}

static int end_piece(struct xml *x)
{
    struct vtk_points points;
    const size_t cells = x->list[CELLS][OFFSETS].count;
    if (add_points(x, &points))
        return -1;
    if (x->cells >= 0 && (x->cells < (double)cells || x->cells > (double)cells))
        return counts_differ(x, "cells", x->cells, cells);
    static const int order[] = {CELLS, VERTS, LINES, POLYS, STRIPS};
    for (size_t i = 0; i < sizeof order / sizeof *order; i++)
        if (add_cells(x, points, order[i]))
            return -1;
    return 0;
}

/* ---- elements */

static int begin_file(struct xml *x, const char **all)
{
    const char *kind = attribute(all, "type"), *header = attribute(all, "header_type");
    x->known = is(kind, "UnstructuredGrid") || is(kind, "PolyData");
    x->big_endian = is(attribute(all, "byte_order"), "BigEndian");
    x->header = is(header, "UInt64") ? 8 : 4;
    const char *compressor = attribute(all, "compressor");
    if (!x->known)
        return report_error(x->mesh.path, line_of(x),
                            "VTK data of type '%.64s' has no faces; write UnstructuredGrid or "
                            "PolyData (ParaView: Extract Surface)",
                            kind ? kind : "");
    x->compressed = compressor && *compressor;
    if (x->compressed && !is(compressor, "vtkZLibDataCompressor"))
        return report_error(x->mesh.path, line_of(x),
                            "the file is compressed by %.64s; let zlib do it, or write it "
                            "uncompressed (ParaView: Save Data, Compressor Type ZLib or None)",
                            compressor);
    return 0;
}

static int begin_array(struct xml *x, const char **all)
{
    const char *name = attribute(all, "Name"), *format = attribute(all, "format"),
               *type = attribute(all, "type"), *components = attribute(all, "NumberOfComponents");
    const int which = x->section == POINTS       ? CONNECTIVITY
                      : is(name, "connectivity") ? CONNECTIVITY
                      : is(name, "offsets")      ? OFFSETS
                      : is(name, "types")        ? TYPES
                                                 : ARRAYS;
    if (which == ARRAYS)
        return 0;
    x->base64 = is(format, "binary");
    snprintf(x->type, sizeof x->type, "%s", type ? type : "Float32");
    if (format && !x->base64 && !is(format, "ascii"))
        return report_error(x->mesh.path, line_of(x),
                            "an array of format '%.64s'; write it inline (ParaView: Save Data, "
                            "Data Mode Ascii or Binary)",
                            format);
    if (x->section == POINTS && components && !is(components, "3"))
        return report_error(x->mesh.path, line_of(x), "points of %.16s numbers; give x, y and z",
                            components);
    x->array = &x->list[x->section][which];
    if (x->array->line)
        return report_error(x->mesh.path, line_of(x),
                            "an array a second time in one piece; the file is damaged, export it "
                            "again");
    x->array->line = line_of(x);
    x->text_size = 0;
    if (x->section == POINTS)
        x->mesh.file->single_precision |= is(x->type, "Float32");
    return 0;
}

static double counted(const char **all, const char *name)
{
    const char *text = attribute(all, name);
    return text ? strtod(text, NULL) : -1;
}

static void XMLCALL begin(void *to, const char *name, const char **all)
{
    static const char *const sections[] = {"Points", "Cells", "Verts", "Lines", "Strips", "Polys"};
    struct xml *x = to;
    x->nested += x->array != NULL;
    if (x->failed || x->array)
        return;
    if (is(name, "VTKFile"))
        fail(x, begin_file(x, all));
    else if (!x->known)
        fail(x, report_error(x->mesh.path, line_of(x),
                             "<%.64s> before <VTKFile>; no VTK file, check the format", name));
    else if (is(name, "Piece")) {
        for (int s = 0; s < SECTIONS; s++)
            for (int i = 0; i < ARRAYS; i++)
                x->list[s][i].count = x->list[s][i].line = 0;
        x->points = counted(all, "NumberOfPoints");
        x->cells = counted(all, "NumberOfCells");
    } else if (is(name, "DataArray") && x->section < SECTIONS)
        fail(x, begin_array(x, all));
    for (int s = 0; s < SECTIONS; s++)
        if (is(name, sections[s]))
            x->section = s;
}

static void XMLCALL end(void *to, const char *name)
{
    struct xml *x = to;
    if (x->failed)
        return;
    if (x->nested) {
        x->nested--;
    } else if (x->array) {
        /* a 0 behind it, for strtod */
        const int full = array_reserve(&x->text, x->text_size + 1, &x->text_capacity, 1);
        if (!full)
            x->text[x->text_size] = '\0';
        fail(x, full        ? scene_file_no_memory(x->mesh.path)
                : x->base64 ? read_bytes(x)
                            : read_words(x));
        x->array = NULL;
    } else if (is(name, "Piece")) {
        fail(x, end_piece(x));
    } else if (!is(name, "DataArray")) {
        x->section = SECTIONS;
    }
}

static void XMLCALL characters(void *to, const char *text, int length)
{
    struct xml *x = to;
    if (x->failed || !x->array || x->nested)
        return;
    if (array_reserve(&x->text, x->text_size + (size_t)length, &x->text_capacity, 1)) {
        fail(x, scene_file_no_memory(x->mesh.path));
        return;
    }
    memcpy(x->text + x->text_size, text, (size_t)length);
    x->text_size += (size_t)length;
}

static int parse(struct xml *x, const char *text, size_t size)
{
    enum { PART = 1 << 20 }; /* expat counts in int */
    for (size_t at = 0;;) {
        const size_t part = size - at < PART ? size - at : PART;
        const int last = at + part == size;
        if (XML_Parse(x->parser, text + at, (int)part, last) != XML_STATUS_OK && !x->failed)
            return report_error(x->mesh.path, line_of(x),
                                "not well-formed XML: %s; the file is cut or damaged, export it "
                                "again",
                                XML_ErrorString(XML_GetErrorCode(x->parser)));
        if (last || x->failed)
            return x->failed ? -1 : 0;
        at += part;
    }
}

int read_vtk_xml(struct scene_file *f, const char *path, char *text, size_t size, int quiet)
{
    struct xml x = {.mesh = {.file = f, .path = path}, .section = SECTIONS, .header = 4};
    x.parser = XML_ParserCreate(NULL);
    if (!x.parser)
        return scene_file_no_memory(path);
    XML_SetUserData(x.parser, &x);
    XML_SetElementHandler(x.parser, begin, end);
    XML_SetCharacterDataHandler(x.parser, characters);
    int result = parse(&x, text, size);
    if (!result)
        result = mesh_finish(&x.mesh, quiet);
    XML_ParserFree(x.parser);
    mesh_free(&x.mesh);
    for (int s = 0; s < SECTIONS; s++)
        for (int i = 0; i < ARRAYS; i++)
            free(x.list[s][i].at);
    free(x.text);
    return result;
}
