/* read_vs3.c - see read_meshes.h: View3D's input, vertices and surfaces (F 3) or planes and
 * outlines in them (F 3a).
 *
 * Here a face of a plane that others share keeps what no earlier one has; there a subsurface takes
 * from its base, whichever comes first. So a subsurface is put before its base, and null and
 * masking surfaces, which only take, are refused. A surface combined with another has the material
 * of that one. [Walton, View3D user manual 3.3]
 * SPDX-License-Identifier: MIT */
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "scene/mesh_parts.h"
#include "scene/read_meshes.h"
#include "scene/read_numbers.h"
#include "scene/text_lines.h"
#include "util/array.h"
#include "util/report.h"

struct surface {
    uint32_t first, size; /* its corners among the file's indices */
    uint32_t material, line, base;
};

struct vs3 {
    struct mesh mesh;
    struct text_lines lines;
    struct surface *surface;
    size_t count, capacity;
    int planes;               /* 1: F 3a */
    struct mesh_note clamped; /* emittances */
    struct mesh_note moved;   /* subsurfaces */
    struct mesh_note obstructions;
};

/* The next word, which may be on another line; a comment ends a line. Returns 0 at the end. */
static int next_value(struct vs3 *v)
{
    for (;;) {
        struct text_lines *t = &v->lines;
        if (t->line && next_word(t) && *t->word != '!' && *t->word != '/')
            return 1;
        if (!next_line(t))
            return 0;
    }
}

static int take_number(struct vs3 *v, const char *what, double *x)
{
    const uint32_t line = v->lines.number;
    if (!next_value(v))
        return report_error(v->mesh.path, line, "ends before %s; the file is cut, export it again",
                            what);
    if (!word_number(&v->lines, x) || !is_finite_float(*x))
        return report_error(v->mesh.path, v->lines.number,
                            "'%.*s' where %s belongs; write a finite number",
                            quoted_length(v->lines.word, v->lines.word_end), v->lines.word, what);
    return 0;
}

static int take_whole(struct vs3 *v, const char *what, uint32_t *i)
{
    double x;
    if (take_number(v, what, &x))
        return -1;
    if (!is_whole(x, 0x1p32 - 1))
        return report_error(v->mesh.path, v->lines.number,
                            "%g where %s belongs; write a whole number", x, what);
    *i = (uint32_t)x;
    return 0;
}

static int read_vertex(struct vs3 *v)
{
    uint32_t number;
    double p[3];
    if (take_whole(v, "a vertex's number", &number) || take_number(v, "x", &p[0])
        || take_number(v, "y", &p[1]) || take_number(v, "z", &p[2]))
        return -1;
    v->lines.word_end = v->lines.line_end;
    return mesh_define_node(&v->mesh, number, p, v->lines.number);
}

/* Base, combination, emittance and name; all but the base are the material's. */
static int read_surface_data(struct vs3 *v, uint32_t number, struct surface *s)
{
    const size_t seen = v->count;
    uint32_t with;
    double emittance;
    char plain[32];
    if (take_whole(v, "a base surface", &s->base)
        || take_whole(v, "the surface to combine with", &with)
        || take_number(v, "an emittance", &emittance))
        return -1;
    if (s->base > seen || with > seen)
        return report_error(v->mesh.path, v->lines.number,
                            "surface %lu names surface %lu, which is not before it; correct the "
                            "number",
                            (unsigned long)number,
                            (unsigned long)(s->base > seen ? s->base : with));
    if (emittance < 0 || emittance > 1)
        return report_error(v->mesh.path, v->lines.number,
                            "surface %lu has emittance %g; it must be within 0 and 1",
                            (unsigned long)number, emittance);
    if (emittance < 1e-3)
        mesh_note(&v->clamped, v->lines.number);
    const double reflectance = 1 - fmax(emittance, 1e-3);
    if (with) {
        s->material = v->surface[with - 1].material;
        next_word(&v->lines); /* its name counts for nothing */
        return 0;
    }
    const char *name = plain;
    size_t length = (size_t)snprintf(plain, sizeof plain, "surface %lu", (unsigned long)number);
    if (next_word(&v->lines) && *v->lines.word != '!' && *v->lines.word != '/') {
        name = v->lines.word;
        length = (size_t)(v->lines.word_end - v->lines.word);
    }
    return mesh_material(&v->mesh, name, length, reflectance, &s->material);
}

static int read_corners(struct vs3 *v, uint32_t number, struct surface *s)
{
    for (int i = 0; i < 4; i++) {
        uint32_t vertex;
        if (take_whole(v, "a vertex's number", &vertex))
            return -1;
        if (!vertex && i == 3)
            break;
        if (numbered_find(&v->mesh.nodes, vertex) == UINT32_MAX)
            return report_error(v->mesh.path, v->lines.number,
                                "surface %lu names vertex %lu, which is not before it; correct the "
                                "number",
                                (unsigned long)number, (unsigned long)vertex);
        if (mesh_corner(&v->mesh, vertex))
            return -1;
        s->size++;
    }
    return 0;
}

/* A plane by a point, the azimuth and the tilt, in degrees; an outline in it. */
static int read_plane(struct vs3 *v, uint32_t number, int shape, struct surface *s)
{
    double at[5], flat[4][2] = {{0}};
    const double degree = M_PI / 180;
    for (int i = 0; i < 5; i++)
        if (take_number(v, "a plane's origin, azimuth and tilt", &at[i]))
            return -1;
    s->size = shape == 'T' ? 3 : 4;
    const int numbers = shape == 'R' ? 2 : 2 * (int)s->size;
    double given[8];
    for (int i = 0; i < numbers; i++)
        if (take_number(v, "a surface's outline", &given[i]))
            return -1;
    for (uint32_t i = 0; i < s->size; i++)
        for (uint32_t k = 0; k < 2; k++)
            flat[i][k] = given[shape == 'R' ? k : 2 * i + k];
    if (shape == 'R') /* down the left side first */
        flat[0][0] = flat[1][0] = flat[1][1] = flat[2][1] = 0;
    /* quarter turns to the last digit, so that walls meet */
    const double turn[2] = {fmod(at[3], 360), fmod(at[4], 360)};
    double c[2], sine[2];
    for (int k = 0; k < 2; k++) {
        const double quarter = turn[k] / 90;
        const int whole = floor(quarter) >= quarter;
        c[k] = whole ? round(cos(turn[k] * degree)) : cos(turn[k] * degree);
        sine[k] = whole ? round(sin(turn[k] * degree)) : sin(turn[k] * degree);
    }
    for (uint32_t i = 0; i < s->size; i++) {
        const double x = flat[i][0], y = flat[i][1] * c[1];
        const double p[3] = {at[0] - x * c[0] - y * sine[0], at[1] + x * sine[0] - y * c[0],
                             at[2] + flat[i][1] * sine[1]};
        for (int k = 0; k < 3; k++)
            if (!is_finite_float(p[k]))
                return report_error(
                    v->mesh.path, v->lines.number,
                    "surface %lu has a corner that is not finite; correct its plane",
                    (unsigned long)number);
        if (scene_file_add_position(v->mesh.file, p)
            || scene_file_add_corner(v->mesh.file, (uint32_t)v->mesh.file->position_count - 1))
            return scene_file_no_memory(v->mesh.path);
    }
    return 0;
}

static int read_surface(struct vs3 *v, int kind)
{
    struct surface s = {.first = (uint32_t)v->mesh.file->index_count, .line = v->lines.number};
    uint32_t number;
    int shape = 0;
    if (take_whole(v, "a surface's number", &number))
        return -1;
    if (number != v->count + 1)
        return report_error(v->mesh.path, s.line,
                            "surface %lu where %zu belongs; number surfaces from 1",
                            (unsigned long)number, v->count + 1);
    if (kind == 'N' || kind == 'M')
        return report_error(v->mesh.path, s.line,
                            "surface %lu is a null or masking surface, which only covers another; "
                            "cut it out of that one",
                            (unsigned long)number);
    if (v->planes) {
        shape = next_value(v) ? toupper((unsigned char)*v->lines.word) : 0;
        if (shape != 'R' && shape != 'T' && shape != 'Q')
            return report_error(v->mesh.path, s.line,
                                "surface %lu is no R, T or Q (rectangle, triangle, quadrilateral); "
                                "correct its shape",
                                (unsigned long)number);
    } else if (read_corners(v, number, &s)) {
        return -1;
    }
    if (kind == 'O')
        mesh_note(&v->obstructions, s.line);
    if (kind == 'O' ? mesh_material(&v->mesh, "obstruction", 11, 0, &s.material)
                    : read_surface_data(v, number, &s))
        return -1;
    if (v->planes && read_plane(v, number, shape, &s))
        return -1;
    if (array_reserve(&v->surface, v->count + 1, &v->capacity, sizeof *v->surface) < 0)
        return scene_file_no_memory(v->mesh.path);
    v->surface[v->count++] = s;
    v->lines.word_end = v->lines.line_end; /* what is left of the line is no entry */
    return 0;
}

static int read_entry(struct vs3 *v)
{
    struct text_lines *t = &v->lines;
    const int kind = toupper((unsigned char)*t->word);
    switch (kind) {
    case 'V':
        return read_vertex(v);
    case 'S':
    case 'M':
    case 'N':
    case 'O':
        return read_surface(v, kind);
    case 'F':
        if (!next_word(t)
            || (!word_is(t, "3") && !word_is_any_case(t, "3d") && !word_is_any_case(t, "3a")))
            return report_error(v->mesh.path, t->number,
                                "a geometry of another kind than 3 or 3a; two-dimensional input is "
                                "not read");
        v->planes = word_is_any_case(t, "3a");
        break;
    case 'T':
    case 'C':
    case 'X':
        break;
    default:
        return report_error(v->mesh.path, t->number,
                            "'%.*s' is no entry of View3D's input (V, S, O, M, T, C, F, E); "
                            "correct the line",
                            quoted_length(t->word, t->word_end), t->word);
    }
    t->word_end = t->line_end;
    return 0;
}

/* ---- subsurfaces before their bases */

static int move_corners(struct vs3 *v, const struct surface *s, uint32_t *indices, size_t *at)
{
    memcpy(&indices[*at], &v->mesh.file->indices[s->first], s->size * sizeof *indices);
    *at += s->size;
    return mesh_polygon(&v->mesh, s->size, s->material, s->line);
}

/* How deep it lies on others: bases are numbered below what lies on them. */
static uint32_t depths(struct vs3 *v, uint32_t *depth)
{
    uint32_t most = 0;
    for (size_t i = 0; i < v->count; i++) {
        const uint32_t base = v->surface[i].base;
        depth[i] = base ? depth[base - 1] + 1 : 0;
        most = depth[i] > most ? depth[i] : most;
        if (base)
            mesh_note(&v->moved, v->surface[i].line);
    }
    return most;
}

static int hand_over(struct vs3 *v)
{
    struct scene_file *f = v->mesh.file;
    uint32_t *depth = calloc(v->count + 1, sizeof *depth);
    uint32_t *from = calloc(v->count + 1, sizeof *from); /* surfaces by depth, in order in each */
    uint32_t *indices = malloc((f->index_count + 1) * sizeof *indices), *start = NULL;
    int result = depth && from && indices ? 0 : scene_file_no_memory(v->mesh.path);
    if (!result) {
        const uint32_t most = depths(v, depth);
        start = calloc((size_t)most + 2, sizeof *start);
        result = start ? 0 : scene_file_no_memory(v->mesh.path);
        for (size_t i = 0; i < v->count && !result; i++)
            start[most - depth[i] + 1]++;
        for (uint32_t d = 0; d < most && !result; d++)
            start[d + 1] += start[d];
        for (size_t i = 0; i < v->count && !result; i++)
            from[start[most - depth[i]]++] = (uint32_t)i;
    }
    size_t at = 0;
    for (size_t i = 0; i < v->count && !result; i++)
        result = move_corners(v, &v->surface[from[i]], indices, &at);
    if (!result && at)
        memcpy(f->indices, indices, at * sizeof *indices);
    free(depth);
    free(from);
    free(indices);
    free(start);
    return result;
}

int read_vs3(struct scene_file *f, const char *path, char *text, size_t size, int quiet)
{
    struct vs3 v = {.mesh = {.file = f, .path = path}, .lines = text_lines(text, size)};
    int result = memchr(text, 0, size)
                     ? report_error(path, 0, "not a text, hence no View3D input; check the format")
                     : 0;
    int ended = 0;
    while (!result && !ended && next_value(&v)) {
        ended = *v.lines.word == '*' || toupper((unsigned char)*v.lines.word) == 'E';
        result = ended ? 0 : read_entry(&v);
    }
    if (!result && !ended && !quiet)
        report_warning(path, v.lines.number,
                       "ends without E or *, which belong behind the last entry: is it cut off?");
    if (!result)
        result = hand_over(&v) || mesh_finish(&v.mesh, quiet) ? -1 : 0;
    if (!result && v.clamped.count && !quiet)
        report_warning(path, v.clamped.first, "%lu emittances below 0.001 are taken for 0.001",
                       (unsigned long)v.clamped.count);
    if (!result && v.moved.count && !quiet)
        report_warning(path, v.moved.first,
                       "%lu subsurfaces take from their bases: their rows come first, all others "
                       "after them in the file's order",
                       (unsigned long)v.moved.count);
    if (!result && v.obstructions.count && !quiet)
        report_warning(path, v.obstructions.first,
                       "%lu obstructions are black surfaces, with rows and columns of their own, "
                       "which View3D leaves out",
                       (unsigned long)v.obstructions.count);
    mesh_free(&v.mesh);
    free(v.surface);
    return result;
}
