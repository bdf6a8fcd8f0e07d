/* read_vtk_xml.c - see read_meshes.h: VTK's XML files, UnstructuredGrid (.vtu) and PolyData (.vtp),
 * by expat.
 *
 * A piece's arrays are kept until the piece ends, as texts are read (vtk_arrays.h); then its cells
 * become faces. What is appended is no XML, as a rule, and expat does not see it.
 * [VTK file formats, XML File Formats]
 * SPDX-License-Identifier: MIT */
#include <expat.h>
#include <stdio.h>
#include <string.h>

#include "scene/read_meshes.h"
#include "scene/read_numbers.h"
#include "scene/vtk_arrays.h"
#include "scene/vtk_cells.h"
#include "util/report.h"

enum { POINTS, CELLS, VERTS, LINES, STRIPS, POLYS, SECTIONS };
enum { CONNECTIVITY, OFFSETS, TYPES, ARRAYS };

struct xml {
    struct mesh mesh;
    XML_Parser parser;
    int failed, known;
    int section;     /* SECTIONS: in none */
    unsigned nested; /* elements begun in the array, which say more of it */
    struct vtk_arrays arrays;
    struct vtk_values *array; /* the one under way, or NULL */
    struct vtk_values list[SECTIONS][ARRAYS];
    double points, cells; /* what the piece counts; -1: does not */
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
    const struct vtk_values *p = &x->list[POINTS][CONNECTIVITY];
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
    const struct vtk_values *list = x->list[section], *offsets = &list[OFFSETS],
                            *corners = &list[CONNECTIVITY];
    double from = 0;
    if (section == CELLS && list[TYPES].count != offsets->count)
        return vtk_wrong_types(&x->mesh, list[TYPES].count, offsets->count, list[TYPES].line);
    for (size_t i = 0; i < offsets->count; i++) {
        const double to = offsets->at[i];
        if (!is_whole(to, (double)corners->count + 1) || to < from)
            return vtk_wrong_offset(&x->mesh, to, corners->count, offsets->line);
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
    x->arrays.big_endian = is(attribute(all, "byte_order"), "BigEndian");
    x->arrays.header = is(header, "UInt64") ? 8 : 4;
    const char *compressor = attribute(all, "compressor");
    if (!x->known)
        return report_error(x->mesh.path, line_of(x),
                            "VTK data of type '%.64s' has no faces; write UnstructuredGrid or "
                            "PolyData (ParaView: Extract Surface)",
                            kind ? kind : "");
    x->arrays.compressed = compressor && *compressor;
    if (x->arrays.compressed && !is(compressor, "vtkZLibDataCompressor"))
        return report_error(x->mesh.path, line_of(x),
                            "the file is compressed by %.64s; let zlib do it, or write it "
                            "uncompressed (ParaView: Save Data, Compressor Type ZLib or None)",
                            compressor);
    return 0;
}

static double counted(const char **all, const char *name)
{
    const char *text = attribute(all, name);
    return text ? strtod(text, NULL) : -1;
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
    struct vtk_arrays *a = &x->arrays;
    a->form = is(format, "binary") ? VTK_BASE64 : is(format, "appended") ? VTK_APPENDED : VTK_WORDS;
    a->offset = counted(all, "offset");
    snprintf(a->type, sizeof a->type, "%s", type ? type : "Float32");
    if (format && a->form == VTK_WORDS && !is(format, "ascii"))
        return report_error(x->mesh.path, line_of(x),
                            "an array of format '%.64s', which is none of ascii, binary and "
                            "appended; the file is damaged, export it again",
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
    x->arrays.size = 0;
    if (x->section == POINTS)
        x->mesh.file->single_precision |= is(a->type, "Float32");
    return 0;
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
        fail(x, vtk_array_read(&x->arrays, x->array));
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
    if (!x->failed && x->array && !x->nested)
        fail(x, vtk_array_add_text(&x->arrays, text, (size_t)length));
}

static int parse(struct xml *x, const char *text, size_t size, int last)
{
    enum { PART = 1 << 20 }; /* expat counts in int */
    for (size_t at = 0;;) {
        const size_t part = size - at < PART ? size - at : PART;
        const int ends = at + part == size;
        if (XML_Parse(x->parser, text + at, (int)part, last && ends) != XML_STATUS_OK && !x->failed)
            return report_error(x->mesh.path, line_of(x),
                                "not well-formed XML: %s; the file is cut or damaged, export it "
                                "again",
                                XML_ErrorString(XML_GetErrorCode(x->parser)));
        if (ends || x->failed)
            return x->failed ? -1 : 0;
        at += part;
    }
}

int read_vtk_xml(struct scene_file *f, const char *path, char *text, size_t size, int quiet)
{
    struct xml x = {.mesh = {.file = f, .path = path},
                    .section = SECTIONS,
                    .arrays = {.path = path, .header = 4}};
    size_t from, to;
    if (vtk_arrays_appended(&x.arrays, text, size, &from, &to))
        return -1;
    x.parser = XML_ParserCreate(NULL);
    if (!x.parser)
        return scene_file_no_memory(path);
    XML_SetUserData(x.parser, &x);
    XML_SetElementHandler(x.parser, begin, end);
    XML_SetCharacterDataHandler(x.parser, characters);
    int result = parse(&x, text, from, to == size);
    if (!result && to < size)
        result = parse(&x, text + to, size - to, 1);
    if (!result)
        result = mesh_finish(&x.mesh, quiet);
    XML_ParserFree(x.parser);
    mesh_free(&x.mesh);
    for (int s = 0; s < SECTIONS; s++)
        for (int i = 0; i < ARRAYS; i++)
            free(x.list[s][i].at);
    vtk_arrays_free(&x.arrays);
    return result;
}
